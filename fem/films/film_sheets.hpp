// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/sheet.hpp"
#include "fem/model/state.hpp"
#include "materials/laws/plane_stress.hpp"

#include <cmath>
#include <vector>

namespace dielast::fem {

/// Voltages under the sheets over one block of film elements, at their integration points.
template<int Corners>
class FilmSheets {
 public:
  using Shape = Eigen::Matrix<double, Corners, 1>;

  /// The next integration point of every element: values of the functions linear between the corners.
  void add_place(const Shape& shape) { shape_.push_back(shape); }
  /// Claims the points of every element; `corner(e, a)` is a node.
  template<class Corner>
  void claim(SheetMap& sheets, const std::vector<int>& electrodes, const Corner& corner) {
    points_.clear();
    bool any = false;
    for (int e = 0; e < static_cast<int>(electrodes.size()); ++e)
      for (int a = 0; a < Corners; ++a) {
        points_.push_back(sheets.claim(electrodes[static_cast<std::size_t>(e)], corner(e, a)));
        any = any || points_.back() != SheetMap::none;
      }
    if (!any) points_.clear();
  }

  bool empty() const { return points_.empty(); }
  /// Whether voltages may vary within an electrode.
  bool vary(const State& state) const { return !empty() && state.sheet_drop.size() > 0; }
  /// Of an element's corners; null where there is no sheet. Requires that there are some.
  const int* points(int element) const {
    const int* first = points_.data() + static_cast<std::ptrdiff_t>(element) * Corners;
    return *first == SheetMap::none ? nullptr : first;
  }
  /// sum_a N_a V_a, V, where the electrode is at `voltage`; that without a sheet.
  double voltage(const State& state, int element, int place, double voltage) const {
    const int* corner = vary(state) ? points(element) : nullptr;
    for (int a = 0; corner && a < Corners; ++a) voltage -= weight(place, a) * state.sheet_drop[corner[a]];
    return voltage;
  }
  /// sum_a N_a V_a^2, V^2, of an element under a sheet whose drops are there.
  double mean_square(const State& state, int element, int place, double voltage) const {
    double square = 0;
    for (int a = 0; a < Corners; ++a) {
      const double V = voltage - state.sheet_drop[points(element)[a]];
      square += weight(place, a) * V * V;
    }
    return square;
  }
  /// Adds an integration point: its capacitance by corners, F, and what flows in the film of deformation C;
  /// `slope`: sqrt(dA0) grad N_a, in the unstretched film.
  void add(SheetMatrices& matrices, int element, const Shape& capacitance,
           const Eigen::Matrix<double, Corners, 2>& slope, const materials::InPlaneC<double>& C) const {
    Eigen::Matrix2d flow; // J C^-1
    flow << C.C22, -C.C12, -C.C12, C.C11;
    flow /= std::sqrt(C.det());
    const Eigen::Matrix<double, Corners, Corners> conductance = slope * flow * slope.transpose();
    const int* corner = points(element);
    for (int a = 0; a < Corners; ++a) {
      matrices.capacitance[corner[a]] += capacitance[a];
      for (int b = 0; b < Corners; ++b)
        matrices.conductance.emplace_back(corner[a], corner[b], conductance(a, b));
    }
  }

 private:
  double weight(int place, int corner) const { return shape_[static_cast<std::size_t>(place)][corner]; }

  std::vector<int> points_;
  std::vector<Shape> shape_;
};

} // namespace dielast::fem
