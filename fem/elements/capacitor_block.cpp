// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/elements/capacitor_block.hpp"

namespace dielast::fem {

namespace {

class CapacitorBlock final : public ElementBlock {
 public:
  explicit CapacitorBlock(const Capacitor& capacitor) : capacitor_(capacitor) {}

  int element_count() const override { return 1; }
  int dofs_per_element() const override { return 0; }
  void claim_dofs(DofMap& /*dofs*/, Dimension /*dimension*/) override {}
  void element_equations(int /*element*/, const DofMap& /*dofs*/,
                         std::span<int> /*equations*/) const override {}
  Evaluation evaluate(const State& state, int /*first*/, int /*last*/,
                      const Scatter& /*scatter*/) const override {
    const double phi = state.voltage[capacitor_.electrode];
    return {-capacitor_.capacitance * phi * phi / 2};
  }
  void sample(const State& /*state*/, Samples& /*samples*/) const override {}
  void add_charges(const State& state, const DofMap* /*dofs*/, Charges& charges) const override {
    charges.capacitance[capacitor_.electrode] += capacitor_.capacitance;
    charges.charge[capacitor_.electrode] += capacitor_.capacitance * state.voltage[capacitor_.electrode];
  }
  /// The field's energy follows from the charges.
  void add_energies(const State& /*state*/, EnergyParts& /*parts*/) const override {}

 private:
  Capacitor capacitor_;
};

} // namespace

std::unique_ptr<ElementBlock> make_capacitor_block(const Capacitor& capacitor) {
  return std::make_unique<CapacitorBlock>(capacitor);
}

} // namespace dielast::fem
