// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshing/meridian.hpp"
#include "meshing/rings.hpp"
#include "tests/fem/chamber_models.hpp"
#include "tests/verification/meridian_stress.hpp"

#include "fem/equilibrium/equilibrium.hpp"

#include <gtest/gtest.h>

#include <numbers>

// References: the ordinary differential equations of the film's meridian (Green & Adkins 1960, ch. IV),
// integrated to a relative 1e-11.
namespace dielast::fem::axisymmetric_membranes_test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double modulus = 45e3, thickness = 1e-3, radius = 0.02; ///< Pa, m, m
constexpr NewtonOptions tight{.tolerance = 1e-11, .max_iterations = 60};

struct InflatedRow {
  double apex_stretch, pressure, height, edge_stretch; ///< p A/(mu H), w/A, l1
};
constexpr InflatedRow inflated[] = {{1.02, 0.06900022040408413, 0.17445149105528762, 1.0238308930362536},
                                    {1.05, 0.23494134530111935, 0.27409255960729745, 1.0567106404666322},
                                    {1.1, 0.5277818197894693, 0.3834724285010873, 1.1043164824403264},
                                    {1.2, 0.999251833864692, 0.5309760700319305, 1.1768824823246284},
                                    {1.3, 1.3098681476995073, 0.6379562054639049, 1.2273918477103818},
                                    {1.4, 1.5112194226189977, 0.7245297918235027, 1.263469243895337},
                                    {1.5, 1.6435818408232918, 0.7987892130092875, 1.2900877409318974},
                                    {1.6, 1.7317482733996825, 0.8648634318074839, 1.3103452288910502}};

/// A flat clamped disc without tension over a chamber of given volume.
class InflatedDisc {
 public:
  explicit InflatedDisc(int elements, int order)
      : mesh_(meshing::disc_meridian(radius, radius / 2, elements, order)) {
    model_ = test::inflatable(mesh_, test::vhb(), radius);
    rim_ = mesh_.node_sets.at("rim").front();
    centre_ = mesh_.node_sets.at("centre").front();
    for (const int c : {0, 2}) model_->dofs.hold(rim_, c);
    model_->dofs.hold(centre_, 0);
    model_->dofs.number();
    equilibrium_ = std::make_unique<Equilibrium>(*model_, 1);
    state_ = model_->initial_state();
    state_.voltage = {1e-2 * pressure_unit};
    EXPECT_EQ(equilibrium_->solve(state_, tight).outcome, Outcome::converged); // from flat
    state_.supply = {Supply::charge};
    filled_ = state_.charge[0] =
        model_->ports[0].chamber->pumped(model_->charges(state_, false).charge[0], state_.voltage[0]);
  }
  /// Fills the chamber until the apex is stretched so far.
  void inflate_to(double apex_stretch) {
    double before = filled_, stretch_before = apex();
    fill(1.05 * filled_);
    for (int iteration = 0; iteration < 30 && std::abs(apex() - apex_stretch) > 1e-11; ++iteration) {
      const double slope = (filled_ - before) / (apex() - stretch_before);
      before = filled_;
      stretch_before = apex();
      fill(std::clamp(filled_ + slope * (apex_stretch - stretch_before), 0.8 * filled_, 1.2 * filled_));
    }
    ASSERT_NEAR(apex(), apex_stretch, 1e-10);
  }
  /// Gives the pressure, in mu H/A.
  void press(double pressure) {
    state_.supply = {Supply::voltage};
    state_.voltage = {pressure * pressure_unit};
    ASSERT_EQ(equilibrium_->solve(state_, tight).outcome, Outcome::converged);
  }
  /// Stretch at the axis: r/R is even in R, so that two nodes tell it to fourth order.
  double apex() const {
    const auto at = [&](int a) {
      const auto n = static_cast<std::size_t>(a);
      const double R = mesh_.nodes[n].x();
      return std::pair{R * R, 1 + state_.displacement[n].x() / R};
    };
    const auto& cells = mesh_.blocks[0];
    const auto last = cells.cell(cells.size() - 1), other = cells.cell(cells.size() - 2);
    const auto [near, q] = at(last[0]);
    const auto [far, p] = at(other[0]);
    return (far * q - near * p) / (far - near);
  }
  double pressure() const { return state_.voltage[0] / pressure_unit; }
  double height() const { return state_.displacement[static_cast<std::size_t>(centre_)].z() / radius; }
  double edge_stretch() const {
    Eigen::VectorXd force;
    equilibrium_->internal_force(state_, force);
    const Eigen::Vector2d pull(force[model_->dofs.equation(rim_, 0)], force[model_->dofs.equation(rim_, 2)]);
    return test::meridional_stretch(pull.norm() / (2 * pi * radius * thickness) / modulus, 1, 0);
  }

 private:
  static constexpr double pressure_unit = modulus * thickness / radius;

  void fill(double volume) {
    state_.charge[0] = filled_ = volume;
    ASSERT_EQ(equilibrium_->solve(state_, tight).outcome, Outcome::converged) << volume;
  }

  meshing::Mesh mesh_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Equilibrium> equilibrium_;
  State state_;
  int rim_ = 0, centre_ = 0;
  double filled_ = 0; ///< pumped volume, m^3
};

TEST(AxisymmetricMembranes, an_inflated_disc_follows_the_reference) {
  InflatedDisc disc(80, 2);
  for (const InflatedRow& row : inflated) {
    SCOPED_TRACE(row.apex_stretch);
    ASSERT_NO_FATAL_FAILURE(disc.inflate_to(row.apex_stretch));
    EXPECT_NEAR(disc.pressure(), row.pressure, 1e-5 * row.pressure);
    EXPECT_NEAR(disc.height(), row.height, 1e-5 * row.height);
    EXPECT_NEAR(disc.edge_stretch(), row.edge_stretch, 1e-5 * row.edge_stretch);
  }
}

TEST(AxisymmetricMembranes, an_inflated_disc_converges_with_second_and_fourth_order) {
  const auto height = [](int elements, int order) {
    InflatedDisc disc(elements, order);
    for (const double pressure : {0.1, 0.4, 1.0}) disc.press(pressure);
    return disc.height();
  };
  const double limit = height(160, 2);
  for (const int order : {1, 2}) {
    const double coarse = height(10, order) - limit, fine = height(20, order) - limit;
    EXPECT_NEAR(std::log2(coarse / fine), 2 * order, 0.3);
  }
}

struct AnnulusRow {
  double field, force;                                    ///< eps (Phi/H)^2/mu, F/(2 pi mu H A)
  double drop, inner_stretch, outer_stretch, inner_slope; ///< u/A, l1, l1, rad
};
constexpr AnnulusRow annuli[] = {
    {0, 0.25, 0.4906746237414523, 1.146754910305581, 1.0928963356389023, 0.5432401553644011},
    {0, 0.5, 0.6644701184471387, 1.2701292021761497, 1.1586427814113582, 0.693605894498494},
    {0, 1.0, 0.9540736524860322, 1.5553184721291422, 1.2849811695796562, 0.8874726080030623},
    {0, 2.0, 1.5290773716115926, 2.3063567495615778, 1.5633849019050508, 1.1173416169050954},
    {0.01, 0.25, 0.4964408603986708, 1.150301589467031, 1.0948563280806236, 0.5455498211142986},
    {0.01, 0.5, 0.6705096166810165, 1.2753164235802248, 1.1609904953988888, 0.6953488791818697},
    {0.01, 1.0, 0.9618452410851979, 1.5651027977543701, 1.288123869718587, 0.8883432594123145},
    {0.01, 2.0, 1.542544863933415, 2.329031004283822, 1.5684629607273675, 1.1157392667048058},
    {0.04, 0.25, 0.5141344137847161, 1.1614815735566273, 1.100958508453295, 0.551909755543956},
    {0.04, 0.5, 0.6891288588138366, 1.2916807739059832, 1.1682543461234616, 0.7001510777532965},
    {0.04, 1.0, 0.9860123872613212, 1.5961715740894646, 1.2978064068545065, 0.8904409226555914},
    {0.04, 2.0, 1.5849853399220797, 2.401392943705436, 1.5840480372024197, 1.1097913896305718},
    {0.09, 0.25, 0.5450135176392727, 1.1821018518388282, 1.1119133852348622, 0.5604295075508736},
    {0.09, 0.5, 0.7219889213352141, 1.3219715606675644, 1.181142629198017, 0.7065663384223607},
    {0.09, 1.0, 1.0295040036320637, 1.6545421853979045, 1.3148357199856058, 0.8919553640419378},
    {0.09, 2.0, 1.6638004738034429, 2.539156120604341, 1.6111985732402958, 1.0953045488903042}};

/// An annulus without tension between a ring (2 A) and a plate (A) that is pushed across: of meridians, or
/// of triangles.
class PushedAnnulus {
 public:
  PushedAnnulus(meshing::Mesh mesh, int points) : mesh_(std::move(mesh)) {
    const std::vector<int> electrodes(static_cast<std::size_t>(mesh_.blocks[0].size()), 0);
    model_ = test::unnumbered_model(mesh_.node_count(), test::dimension_of(mesh_),
                                    make_membrane_block(mesh_, mesh_.blocks[0], test::vhb(), electrodes,
                                                        test::dimension_of(mesh_), points));
    plate_ = mesh_.node_sets.at("inner").front();
    for (const int a : mesh_.node_sets.at("inner")) {
      for (const int c : {0, 1}) model_->dofs.hold(a, c);
      model_->dofs.share(plate_, a, 2);
    }
    for (const int a : mesh_.node_sets.at("outer"))
      for (int c = 0; c < 3; ++c) model_->dofs.hold(a, c);
    model_->dofs.number();
    model_->length_scale = model_->extent = 2 * radius;
    equilibrium_ = std::make_unique<Equilibrium>(*model_, 1);
    state_ = model_->initial_state();
    for (std::size_t a = 0; a < mesh_.nodes.size(); ++a) // flat without tension it has no stiffness
      state_.displacement[a].z() = 0.2 * (2 * radius - mesh_.nodes[a].norm());
  }
  void push(const AnnulusRow& row) {
    state_.dead_force[model_->dofs.equation(plate_, 2)] = row.force * 2 * pi * modulus * thickness * radius;
    state_.voltage = {thickness * std::sqrt(row.field * modulus / 4e-11)};
    ASSERT_EQ(equilibrium_->solve(state_, tight).outcome, Outcome::converged);
    equilibrium_->internal_force(state_, force_);
  }
  double drop() const { return state_.displacement[static_cast<std::size_t>(plate_)].z() / radius; }
  /// Radial and vertical pull of the film on an edge, N.
  Eigen::Vector2d pull(const char* edge) const {
    return test::pull(model_->dofs, mesh_, mesh_.node_sets.at(edge), force_);
  }

 private:
  meshing::Mesh mesh_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Equilibrium> equilibrium_;
  State state_;
  Eigen::VectorXd force_;
  int plate_ = 0;
};

TEST(AxisymmetricMembranes, a_pushed_annulus_follows_the_reference) {
  PushedAnnulus annulus(meshing::annulus_meridian(radius, 2 * radius, 60, 2, 3), 3);
  for (const AnnulusRow& row : annuli) {
    SCOPED_TRACE(testing::Message() << row.field << " " << row.force);
    ASSERT_NO_FATAL_FAILURE(annulus.push(row));
    EXPECT_NEAR(annulus.drop(), row.drop, 1e-5 * row.drop);
    const auto stretch = [&](const char* edge, double r) {
      return test::meridional_stretch(annulus.pull(edge).norm() / (2 * pi * r * thickness * modulus), 1,
                                      row.field);
    };
    EXPECT_NEAR(stretch("inner", radius), row.inner_stretch, 1e-5 * row.inner_stretch);
    EXPECT_NEAR(stretch("outer", 2 * radius), row.outer_stretch, 1e-5 * row.outer_stretch);
    const Eigen::Vector2d inner = annulus.pull("inner").cwiseAbs();
    EXPECT_NEAR(std::atan2(inner[1], inner[0]), row.inner_slope, 1e-5 * row.inner_slope);
  }
}

TEST(AxisymmetricMembranes, a_pushed_annulus_converges_with_the_order_of_its_elements) {
  const AnnulusRow& row = annuli[14];
  const auto observed = [&](const auto& mesh, int points, int coarse) {
    const auto error = [&](int elements) {
      PushedAnnulus annulus(mesh(elements), points);
      annulus.push(row);
      return annulus.drop() / row.drop - 1;
    };
    return std::log2(error(coarse) / error(2 * coarse));
  };
  for (const int order : {1, 2}) {
    const auto meridian = [&](int n) { return meshing::annulus_meridian(radius, 2 * radius, n, order, 1); };
    EXPECT_NEAR(observed(meridian, order + 1, 10), 2 * order, 0.2);
    const auto rings = [&](int n) { return meshing::annulus_mesh(radius, 2 * radius, n, order, order == 2); };
    EXPECT_NEAR(observed(rings, order == 1 ? 1 : 6, 4), 2 * order, 0.3);
  }
}

} // namespace
} // namespace dielast::fem::axisymmetric_membranes_test
