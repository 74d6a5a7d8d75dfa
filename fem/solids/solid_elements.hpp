// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"
#include "fem/solids/solid_block.hpp"
#include "fem/solids/solid_response.hpp"
#include "meshing/mesh.hpp"

#include <array>
#include <optional>

namespace dielast::fem {

/// A plane of the drawing in which a solid is meshed, and what happens across it. Local axes 1 and 2 lie in
/// the plane, 3 is across it: thickness of plane strain, hoop of a solid of revolution.
struct SolidPlane {
  std::array<int, 3> axis; ///< x, y, z (0..2) of the local axes
  bool of_revolution;      ///< 1 is the radius
};
constexpr SolidPlane plane_strain{{0, 1, 2}, false}, revolution{{0, 2, 1}, true};

/// One integration point of an element as drawn.
struct SolidPoint {
  static constexpr int nodes = 6, corners = 3;

  Eigen::Matrix<double, nodes, 2> gradient; ///< of the shape functions, 1/m
  Eigen::Vector<double, nodes> hoop;        ///< shape functions over the radius, 1/m; 0 in plane strain
  Eigen::Vector<double, corners> pressure;  ///< shape functions of the pressure
  double volume = 0;                        ///< that it stands for, m^3
};

/// An element in a state.
struct SolidElementState {
  Eigen::Matrix<double, 2, SolidPoint::nodes> displacement; ///< m
  Eigen::Vector<double, SolidPoint::corners> pressure;      ///< Pa
  Eigen::Vector<double, SolidPoint::nodes> potential;       ///< V
  std::optional<Eigen::Vector3d> given_field;               ///< E0 of layers, local axes, V/m
  /// F, local axes.
  Eigen::Matrix3d deformation(const SolidPoint& at) const;
  /// E0, local axes, V/m.
  Eigen::Vector3d field(const SolidPoint& at) const;
};

/// See make_solid_block().
class SolidBlock final : public ElementBlock {
 public:
  static constexpr int nodes = SolidPoint::nodes, corners = SolidPoint::corners, points = 6;
  static constexpr int dofs = 2 * nodes + corners + nodes; ///< displacements, pressures, potentials

  SolidBlock(const meshing::Mesh& mesh, const SolidCells& cells, const std::vector<SolidSection>& sections,
             std::vector<int> potentials, Dimension dimension);

  int element_count() const override { return count_; }
  int dofs_per_element() const override { return dofs; }
  void place_scalars(DofMap& dofs) override;
  void claim_dofs(DofMap& dofs, Dimension dimension) const override;
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
  using Vector = Eigen::Vector<double, dofs>;
  using Matrix = Eigen::Matrix<double, dofs, dofs>;

  /// The potentials of this block's nodes in equilibrium, those of electrodes and ground being given per
  /// node, V; with the charges per node that this takes, C.
  struct NodalField {
    std::vector<double> potential, charge;
  };
  NodalField solve_field(const State& state, std::vector<double> given) const;
  void place_element(const meshing::Mesh& mesh, int element);
  int node(int element, int a) const { return nodes_[static_cast<std::size_t>(element * nodes + a)]; }
  const SolidPoint& point(int element, int p) const {
    return geometry_[static_cast<std::size_t>(element * points + p)];
  }
  bool has_potential() const { return !potentials_.empty(); }
  int electrode(int element) const { return electrodes_[static_cast<std::size_t>(element)]; }
  double potential_at(const State& state, int node) const;
  SolidElementState at(const State& state, int element) const;
  /// Adds volume * (derivatives of the potential) to residual and tangent; the tangent where it is wanted.
  void add_point(const SolidPoint& at, const Eigen::Matrix3d& F, const SolidDensity& density,
                 Vector& residual, Matrix* tangent) const;
  /// Minus the second derivatives of the energy in the nodes' potentials: positive semi-definite, F.
  Eigen::Matrix<double, nodes, nodes> capacitances(const State& state, int element) const;

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

  SolidPlane plane_;
  std::vector<Part> parts_;
  int count_;
  std::vector<int> nodes_;
  std::vector<int> numbers_;    ///< of the elements in the mesh's block
  std::vector<int> electrodes_; ///< of the elements, `passive`: none
  std::vector<int> sections_;   ///< of the elements
  std::vector<int> place_;      ///< of the elements in their parts
  std::vector<int> potentials_; ///< of the mesh's nodes: an electrode or a NodePotential; empty: given field
  std::vector<SolidPoint> geometry_;      ///< `points` per element
  double pressure_unit_, potential_unit_; ///< Pa, V: see DofMap::add_scalar
  std::vector<int> pressure_scalar_;      ///< `corners` per element
  std::vector<int> potential_scalar_;     ///< per node of the mesh
};

} // namespace dielast::fem
