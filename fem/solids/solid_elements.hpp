// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/films/triangle.hpp"
#include "fem/model/element_block.hpp"
#include "fem/solids/solid_block.hpp"
#include "fem/solids/solid_response.hpp"
#include "fem/solids/tetrahedron.hpp"
#include "materials/laws/pack.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <optional>
#include <span>
#include <type_traits>

namespace dielast::fem {

/// Which of x, y, z (0..2) the local axes 1, 2, 3 of an element are. Those of triangles lie 1 and 2 in the
/// plane of the drawing, 3 across it: thickness of plane strain, hoop of a solid of revolution.
struct SolidAxes {
  std::array<int, 3> axis;
  bool of_revolution; ///< 1 is the radius
};
constexpr SolidAxes as_drawn{{0, 1, 2}, false}, revolution{{0, 2, 1}, true};

/// 6-node triangles, integrated with degree 4.
struct SolidTriangle {
  static constexpr int dim = 2, nodes = 6, corners = 3, points = 6;
  static constexpr const char* name = "triangle";
  static const TrianglePoint& at(int point) { return triangle_rule(points)[static_cast<std::size_t>(point)]; }
  static double weight(int point) { return at(point).weight; }
  template<int Nodes>
  static Eigen::Vector<double, Nodes> shape(int point) {
    return shape_values<Nodes>(at(point).xi, at(point).eta);
  }
  static Eigen::Matrix<double, nodes, dim> slope(int point) {
    return shape_gradients<nodes>(at(point).xi, at(point).eta);
  }
  /// use(shape functions, volume): a rule for products of shape functions, made of what the points stand for.
  template<class Volume, class Use>
  static void for_each_mass(const Volume& volume, const Use& use) {
    for (int p = 0; p < points; ++p) use(shape<nodes>(p), volume(p));
  }
};

/// 10-node tetrahedra, integrated with degree 2: what quadratic displacements need for their full order.
struct SolidTetrahedron {
  static constexpr int dim = 3, nodes = 10, corners = 4, points = 4;
  static constexpr const char* name = "tetrahedron";
  static const TetrahedronPoint& at(int point) { return tetrahedron_rule()[static_cast<std::size_t>(point)]; }
  static double weight(int point) { return at(point).weight; }
  template<int Nodes>
  static Eigen::Vector<double, Nodes> shape(int point) {
    return tetrahedron_shape<Nodes>(at(point).local);
  }
  static Eigen::Matrix<double, nodes, dim> slope(int point) {
    return tetrahedron_slope<nodes>(at(point).local);
  }
  template<class Volume, class Use>
  static void for_each_mass(const Volume& volume, const Use& use) {
    for (const TetrahedronMassPoint& at : tetrahedron_mass_rule()) {
      double whole = 0;
      for (int p = 0; p < points; ++p) whole += at.share[static_cast<std::size_t>(p)] * volume(p);
      use(at.shape, whole);
    }
  }
};

/// One integration point of an element as drawn.
template<class Element>
struct SolidPoint {
  /// Of the shape functions along the local axes, 1/m; across a triangle they are over the radius, and what
  /// they act on is the displacement along the radius (0 in plane strain).
  Eigen::Matrix<double, Element::nodes, 3> gradient;
  Eigen::Vector<double, Element::corners> pressure; ///< shape functions of the pressure
  double volume = 0;                                ///< that it stands for, m^3
};

/// An element in a state.
template<class Element>
struct SolidElementState {
  Eigen::Matrix<double, Element::dim, Element::nodes> displacement; ///< m
  Eigen::Vector<double, Element::corners> pressure;                 ///< Pa
  Eigen::Vector<double, Element::nodes> potential;                  ///< V
  std::optional<Eigen::Vector3d> given_field;                       ///< E0 of layers, local axes, V/m
  /// F, local axes.
  Eigen::Matrix3d deformation(const SolidPoint<Element>& at) const;
  /// E0, local axes, V/m.
  Eigen::Vector3d field(const SolidPoint<Element>& at) const;
};

/// Derivatives of an element's energy in its unknowns: displacements (of all nodes along one axis, then along
/// the next), pressures, and potentials where they are unknowns.
template<class Element>
struct SolidSums {
  static constexpr int nodes = Element::nodes, motions = Element::dim * nodes,
                       potential_place = motions + Element::corners, dofs = potential_place + nodes;
  /// Of the nodes, filled up with zeros to whole packs.
  static constexpr int packs = (nodes + materials::pack_lanes - 1) / materials::pack_lanes;
  using Row = std::array<materials::Pack, static_cast<std::size_t>(packs)>;
  using Slopes = std::array<Row, static_cast<std::size_t>(3 * Element::points)>; ///< three rows per point

  explicit SolidSums(materials::Derivatives wanted) {
    first.setZero();
    if (wanted == materials::Derivatives::first) return;
    mixed = {};
    of_scalars.setZero();
  }
  /// The second derivatives in the first `used` unknowns, rows of the lower triangle one after the other.
  /// Those of displacements are summed over all points at once, so that sums stay in registers.
  std::span<const double> lower_triangle(int used, std::span<double> packed) const;

  Eigen::Vector<double, dofs> first;
  /// How the derivatives in pressures and potentials go with displacements along each axis.
  std::array<std::array<Row, static_cast<std::size_t>(Element::dim)>,
             static_cast<std::size_t>(dofs - motions)>
      mixed;
  Eigen::Matrix<double, dofs - motions, dofs - motions, Eigen::RowMajor> of_scalars; ///< both in these
  int points = 0;                                                                    ///< so far
  Slopes slope; ///< gradients of the shape functions
  /// How the stress of axis i goes with displacements along axis j <= i, at dim i + j.
  std::array<Slopes, static_cast<std::size_t>(Element::dim* Element::dim)> stiff;
};

/// See make_solid_block().
template<class Element>
class SolidBlock final : public ElementBlock {
 public:
  static constexpr int dim = Element::dim, nodes = Element::nodes, corners = Element::corners,
                       points = Element::points;
  using Sums = SolidSums<Element>;
  static constexpr int motions = Sums::motions, potential_place = Sums::potential_place, dofs = Sums::dofs;

  SolidBlock(const meshing::Mesh& mesh, const SolidCells& cells, const std::vector<SolidSection>& sections,
             std::vector<int> potentials, Dimension dimension);

  int element_count() const override { return count_; }
  int dofs_per_element() const override { return has_potential() ? dofs : potential_place; }
  void place_scalars(DofMap& dofs) override;
  void claim_dofs(DofMap& dofs, Dimension dimension) override;
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override;
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override;
  void sample(const State& state, Samples& samples) const override;
  void add_charges(const State& state, const DofMap* dofs, Charges& charges) const override;
  void balance_field(State& state) const override;
  double screened_capacitance(const State& state, std::size_t electrode) const override;
  void add_energies(const State& state, EnergyParts& parts) const override;
  void add_mass(int element, std::span<double> packed) const override;
  void add_relaxation(const State& state, const RateWeight& weight, const Scatter& scatter) const override;
  int history_size() const override;
  void place_history(int first) override;
  void start_history(std::vector<double>& all) const override;
  void advance_history(const State& state, std::vector<double>& all) const override;

 private:
  static constexpr int none = -1; ///< no scalar
  using Point = SolidPoint<Element>;
  using ElementState = SolidElementState<Element>;
  using NodalMatrix = Eigen::Matrix<double, nodes, nodes>;

  /// The potentials of this block's nodes in equilibrium, those of electrodes and ground being given per
  /// node, V; with the charges per node that this takes, C.
  struct NodalField {
    std::vector<double> potential, charge;
  };
  NodalField solve_field(const State& state, std::vector<double> given) const;
  void place_element(const meshing::Mesh& mesh, int element);
  int node(int element, int a) const { return nodes_[static_cast<std::size_t>(element * nodes + a)]; }
  const Point& point(int element, int p) const {
    return geometry_[static_cast<std::size_t>(element * points + p)];
  }
  bool has_potential() const { return !potentials_.empty(); }
  int electrode(int element) const { return electrodes_[static_cast<std::size_t>(element)]; }
  double potential_at(const State& state, int node) const;
  ElementState at(const State& state, int element) const;
  /// Adds volume * (derivatives of the potential); those twice in displacements follow in lower_triangle().
  void add_point(const Point& at, const Eigen::Matrix3d& F, const SolidDensity& density, Sums& sums,
                 materials::Derivatives wanted) const;
  /// Minus the second derivatives of the energy in the nodes' potentials: positive semi-definite, F.
  NodalMatrix capacitances(const State& state, int element) const;

  /// A part of one material.
  struct Part {
    SolidResponse response;
    double thickness, width; ///< of SolidSection, m
    Eigen::Vector3d normal;  ///< of the layers, local axes
    int elements;
  };
  const Part& part(int element) const {
    return parts_[static_cast<std::size_t>(sections_[static_cast<std::size_t>(element)])];
  }
  /// Number of an integration point within its part.
  int place(int element, int p) const { return place_[static_cast<std::size_t>(element)] * points + p; }

  SolidAxes axes_;
  std::vector<Part> parts_;
  int count_;
  std::vector<int> nodes_;
  std::vector<int> numbers_;    ///< of the elements in the mesh's block
  std::vector<int> electrodes_; ///< of the elements, `passive`: none
  std::vector<int> sections_;   ///< of the elements
  std::vector<int> place_;      ///< of the elements in their parts
  std::vector<int> potentials_; ///< of the mesh's nodes: an electrode or a NodePotential; empty: given field
  std::vector<Point> geometry_; ///< `points` per element
  double pressure_unit_, potential_unit_; ///< Pa, V: see DofMap::add_scalar
  std::vector<int> pressure_scalar_;      ///< `corners` per element
  std::vector<int> potential_scalar_;     ///< per node of the mesh
};

} // namespace dielast::fem
