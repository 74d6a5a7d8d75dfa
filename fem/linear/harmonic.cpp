// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/linear/harmonic.hpp"

#include "fem/algebra/dense_algebra.hpp"
#include "fem/linear/response_basis.hpp"

#include <bit>
#include <stdexcept>
#include <string>

namespace dielast::fem {

namespace {

/// What a port says: voltage dPhi + charge dQ = given.
struct PortEquation {
  Linearisation::Complex voltage, charge, given;
};

PortEquation equation_of(const Linearisation::Port& port, Linearisation::Complex s, double drive) {
  switch (port.supply) {
  case Supply::voltage:
    return {1, 0, drive};
  case Supply::charge:
    return {0, 1, drive};
  case Supply::circuit:
  case Supply::leak: // without a conductance
    return {port.conductance + port.leakage, s, port.conductance * drive};
  }
  return {};
}

/// The first and the last, then what lies in the middle between those before.
std::vector<std::size_t> halving_order(std::size_t count) {
  std::vector<std::size_t> order;
  if (count > 0) order.push_back(0);
  if (count > 1) order.push_back(count - 1);
  for (std::size_t stride = std::bit_ceil(count) / 2; stride > 0; stride /= 2)
    for (std::size_t i = stride; i + 1 < count; i += 2 * stride) order.push_back(i);
  return order;
}

} // namespace

HarmonicDrive HarmonicDrive::at_port(const Model& model, std::size_t port) {
  const auto ports = static_cast<Eigen::Index>(model.ports.size());
  return {Eigen::VectorXd::Unit(ports, static_cast<Eigen::Index>(port)),
          Eigen::VectorXd::Zero(model.dofs.free_count())};
}

HarmonicDrive HarmonicDrive::along(const Model& model, int equation) {
  return {Eigen::VectorXd::Zero(static_cast<Eigen::Index>(model.ports.size())),
          Eigen::VectorXd::Unit(model.dofs.free_count(), equation)};
}

std::vector<HarmonicResponse> harmonic_response(const Linearisation& at, const HarmonicDrive& drive,
                                                std::span<const double> frequencies) {
  const auto& ports = at.ports();
  const auto count = static_cast<Eigen::Index>(ports.size());
  Eigen::MatrixXd columns(drive.force.size(), count + 1); // per port what its voltage pulls, then the force
  for (Eigen::Index p = 0; p < count; ++p) columns.col(p) = ports[static_cast<std::size_t>(p)].coupling;
  columns.col(count) = drive.force;

  Eigen::MatrixXd moving = columns; // a voltage that is given and does not swing moves nothing
  for (Eigen::Index p = 0; p < count; ++p)
    if (ports[static_cast<std::size_t>(p)].supply == Supply::voltage && drive.source[p] == 0)
      moving.col(p).setZero();
  ResponseBasis basis(at, std::move(moving));
  std::vector<HarmonicResponse> responses(frequencies.size());
  for (const std::size_t place : halving_order(frequencies.size())) {
    const double omega = frequencies[place];
    const Linearisation::Complex s(0, omega);
    const auto found = basis.solve(s);
    if (!found) throw std::domain_error("undamped resonance at " + std::to_string(omega) + " rad/s");
    const Eigen::MatrixXcd& X = *found;
    // dQ = held dPhi + pressed
    Eigen::MatrixXcd held = columns.leftCols(count).transpose() * X.leftCols(count);
    const Eigen::VectorXcd pressed = columns.leftCols(count).transpose() * X.col(count);
    Eigen::MatrixXcd A(count, count);
    Eigen::VectorXcd b(count), leakage(count);
    for (Eigen::Index p = 0; p < count; ++p) {
      const auto& port = ports[static_cast<std::size_t>(p)];
      held(p, p) += port.capacitance;
      leakage[p] = port.leakage;
      const PortEquation equation = equation_of(port, s, drive.source[p]);
      A.row(p) = equation.charge * held.row(p);
      A(p, p) += equation.voltage;
      b[p] = equation.given - equation.charge * pressed[p];
      const double size = A.row(p).cwiseAbs().maxCoeff(); // volts and coulombs differ by orders
      A.row(p) /= size;
      b[p] /= size;
    }
    HarmonicResponse response{.frequency = omega};
    response.voltage = count > 0 ? Eigen::VectorXcd(solve_dense(A, b)) : b;
    response.displacement = X.leftCols(count) * response.voltage + X.col(count);
    response.charge = held * response.voltage + pressed;
    response.current = s * response.charge + leakage.cwiseProduct(response.voltage);
    responses[place] = std::move(response);
  }
  return responses;
}

} // namespace dielast::fem
