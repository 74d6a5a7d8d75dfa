// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/equilibrium/tangent_check.hpp"

#include "tests/fem/sample_meshes.hpp"
#include "tests/fem/sample_models.hpp"

#include <gtest/gtest.h>

namespace dielast::fem::tangent_check_test {
namespace {

constexpr double side = 0.01;

/// A block whose residual or tangent is off by a factor: what the check is there to find.
class Spoilt : public ElementBlock {
 public:
  Spoilt(std::unique_ptr<ElementBlock> block, double residual, double tangent)
      : block_(std::move(block)), residual_(residual), tangent_(tangent) {}
  int element_count() const override { return block_->element_count(); }
  int dofs_per_element() const override { return block_->dofs_per_element(); }
  int granularity() const override { return element_count(); }
  void claim_dofs(DofMap& dofs, Dimension dimension) override { block_->claim_dofs(dofs, dimension); }
  void element_equations(int element, const DofMap& dofs, std::span<int> equations) const override {
    block_->element_equations(element, dofs, equations);
  }
  Evaluation evaluate(const State& state, int first, int last, const Scatter& scatter) const override {
    Scatter spoilt = scatter;
    std::vector<double> residual(1000), tangent(100000);
    if (scatter.residual) spoilt.residual = residual.data();
    if (scatter.tangent) spoilt.tangent = tangent.data();
    const Evaluation evaluation = block_->evaluate(state, first, last, spoilt);
    for (std::size_t i = 0; scatter.residual && i < residual.size(); ++i)
      if (residual[i] != 0) scatter.residual[i] += residual_ * residual[i];
    for (std::size_t i = 0; scatter.tangent && i < tangent.size(); ++i)
      if (tangent[i] != 0) scatter.tangent[i] += tangent_ * tangent[i];
    return evaluation;
  }
  void sample(const State& state, Samples& samples) const override { block_->sample(state, samples); }

 private:
  std::unique_ptr<ElementBlock> block_;
  double residual_, tangent_;
};

/// A square film under voltage whose right derivatives are multiplied.
TangentCheck check(int order, bool planar, double residual = 1, double tangent = 1) {
  const meshing::Mesh mesh = test::distorted_square(3, order, side);
  auto film = make_membrane_block(mesh, mesh.blocks[0], test::vhb(3, 3),
                                  std::vector<int>(static_cast<std::size_t>(mesh.blocks[0].size()), 0),
                                  test::dimension(planar), order == 2 ? 3 : 1);
  auto model = test::unnumbered_model(mesh.node_count(), planar,
                                      std::make_unique<Spoilt>(std::move(film), residual, tangent));
  for (const int n : mesh.node_sets.at("edge"))
    for (int c = 0; c < 3; ++c) model->dofs.hold(n, c);
  model->dofs.number();
  model->length_scale = side / 3;
  model->extent = side;
  Equilibrium equilibrium(*model, 1);
  State state = model->initial_state();
  state.voltage = {3000};
  return check_tangent(equilibrium, state, 0.02 * side / 3, 4);
}

TEST(TangentCheck, PassesOfFilms) {
  for (const int order : {1, 2})
    for (const bool planar : {true, false}) {
      const TangentCheck found = check(order, planar);
      EXPECT_EQ(found.directions, 4);
      EXPECT_LT(found.residual, 1e-8) << order << planar;
      EXPECT_LT(found.tangent, 1e-6) << order << planar;
    }
}

TEST(TangentCheck, PassesOfBeams) {
  for (const bool planar : {true, false}) {
    const meshing::Mesh mesh = test::line(4, 2, [](double s) { return Eigen::Vector3d(s, s * s, 0); });
    auto model = test::free_model(mesh.node_count(), planar,
                                  make_beam_block(mesh, mesh.blocks[0], test::uneven_section()));
    Equilibrium equilibrium(*model, 1);
    const TangentCheck found = check_tangent(equilibrium, model->initial_state(), 0.02, 4);
    EXPECT_LT(found.residual, 1e-6) << planar;
    EXPECT_LT(found.tangent, 1e-6) << planar;
  }
}

TEST(TangentCheck, FindsWrongDerivatives) {
  const TangentCheck residual = check(2, true, 1.001, 1), tangent = check(2, true, 1, 1.001);
  EXPECT_GT(residual.residual, 1e-6);
  EXPECT_NEAR(residual.tangent, 1e-3, 1e-4); // it is compared with that residual
  EXPECT_LT(tangent.residual, 1e-6);
  EXPECT_NEAR(tangent.tangent, 1e-3, 1e-4);
}

TEST(TangentCheck, IsRepeatable) {
  EXPECT_EQ(check(2, false).residual, check(2, false).residual);
  EXPECT_EQ(check(2, false).tangent, check(2, false).tangent);
}

} // namespace
} // namespace dielast::fem::tangent_check_test
