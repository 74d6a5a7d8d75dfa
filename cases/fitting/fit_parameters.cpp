// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/fitting/fit_parameters.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

using materials::Branch;
using materials::ElasticLaw;
using materials::Material;

double relaxation_time(const Branch& branch) {
  return branch.viscosity / materials::initial_shear_modulus(branch.law);
}
void set_relaxation_time(Branch& branch, double tau) {
  branch.viscosity = tau * materials::initial_shear_modulus(branch.law);
}

/// Adds the parameters of a law. `law(material)` returns a reference to it; `change(material, write)` calls
/// write on it.
template<class Law, class Change>
void add_law(std::vector<FitParameter>& all, const std::string& prefix, const ElasticLaw& now, Law law,
             Change change) {
  std::visit(
      [&]<class S>(const S& held) {
        const auto add = [&](const materials::Parameter& row, const std::string& name, auto part) {
          all.push_back({prefix + name, std::string(row.unit), row.above, row.below,
                         [=](const Material& material) { return part(std::get<S>(law(material))); },
                         [=](Material& material, double value) {
                           change(material, [&](ElasticLaw& one) { part(std::get<S>(one)) = value; });
                         }});
        };
        for (const auto& row : S::parameters) {
          const std::string name(row.name);
          if (row.number)
            add(
                row, name, [member = row.number](auto& one) -> auto& { return one.*member; });
          else
            for (std::size_t i = 0; i < (held.*row.list).size(); ++i)
              add(
                  row, fmt::format("{}[{}]", name, i + 1),
                  [ member = row.list, i ](auto& one) -> auto& { return (one.*member)[i]; });
        }
      },
      now);
}

} // namespace

std::vector<FitParameter> fit_parameters(const Material& material, const std::vector<bool>& keeps_viscosity) {
  std::vector<FitParameter> all;
  add_law(
      all, "", material.law, [](const Material& one) -> const ElasticLaw& { return one.law; },
      [](Material& one, const auto& write) { write(one.law); });
  if (material.viscosity > 0)
    all.push_back({.name = "viscosity",
                   .unit = "Pa s",
                   .get = [](const Material& one) { return one.viscosity; },
                   .set = [](Material& one, double eta) { one.viscosity = eta; }});
  for (std::size_t b = 0; b < material.branches.size(); ++b) {
    const bool viscous = b < keeps_viscosity.size() && keeps_viscosity[b];
    const std::string prefix = fmt::format("branch[{}].", b + 1);
    add_law(
        all, prefix, material.branches[b].law,
        [b](const Material& one) -> const ElasticLaw& { return one.branches[b].law; },
        [b, viscous](Material& one, const auto& write) {
          const double tau = relaxation_time(one.branches[b]);
          write(one.branches[b].law);
          if (!viscous) set_relaxation_time(one.branches[b], tau);
        });
    if (viscous) {
      all.push_back({.name = prefix + "viscosity",
                     .unit = "Pa s",
                     .get = [b](const Material& one) { return one.branches[b].viscosity; },
                     .set = [b](Material& one, double eta) { one.branches[b].viscosity = eta; }});
      continue;
    }
    FitParameter time{.name = prefix + "relaxation_time", .unit = "s"};
    time.get = [b](const Material& one) { return relaxation_time(one.branches[b]); };
    time.set = [b](Material& one, double tau) { set_relaxation_time(one.branches[b], tau); };
    all.push_back(std::move(time));
  }
  return all;
}

} // namespace dielast::cases
