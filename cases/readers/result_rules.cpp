// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/case/holding.hpp"
#include "cases/case/quantities.hpp"
#include "cases/language/conditions.hpp"
#include "cases/readers/rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace dielast::cases {
namespace {

/// Items of a list that the user has written; those of the template stand in front.
std::size_t written_items(const Node& list) {
  return static_cast<std::size_t>(
      std::ranges::count_if(list.items, [](const Node& item) { return item.source.is_written(); }));
}

/// A state is read at the end of a step that leads to one.
void check_step_with_end(SectionReader& reader, const Case& one, const Node* written, const std::string& key,
                         const std::string& step) {
  const auto named = std::ranges::find(one.steps, step, &Step::name);
  if (named != one.steps.end() && named->is_analysis())
    reader.report(written->source, key,
                  fmt::format("found \"{}\": a step of this kind leaves the state as it is; name the step "
                              "before it",
                              step));
}

/// What counts from the end of the last step is 0, which is no surprise where no voltage came before.
void check_beginnings(SectionReader& reader, const Node& tree, const Case& one) {
  const auto last = std::ranges::find_if(one.steps.rbegin(), one.steps.rend(),
                                         [](const Step& step) { return !step.is_analysis(); });
  const bool driven = std::any_of(last, one.steps.rend(), [&](const Step& step) {
    return &step != &*last && (step.kind == StepKind::voltage || step.kind == StepKind::charge ||
                               step.kind == StepKind::transient);
  });
  if (!driven) return;
  std::vector<std::string> names;
  for (const Quantity& quantity : one.quantities)
    if (quantity.kind->since && quantity.since == last->name) names.push_back(quantity.name);
  if (names.empty()) return;
  const auto number = static_cast<std::size_t>(one.steps.rend() - last) - 1;
  reader.warn(
      tree.find("step")->items.at(number).source, fmt::format("step[{}]", number + 1),
      fmt::format("{} from the end of step \"{}\", behind which nothing moves here: 0 at the end of the "
                  "run; let the voltage follow it, or ask for a [[quantity]] without since",
                  fmt::format("{} count{}", fmt::join(names, ", "), names.size() > 1 ? "" : "s"),
                  last->name));
}

/// What is measured must be there.
void check_quantities(SectionReader& reader, const Node& tree, const Case& one) {
  const Node* list = tree.find("quantity");
  const std::size_t standard = list ? list->items.size() - written_items(*list) : 0;
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    if (!list || q >= list->items.size() || !list->items[q].source.is_written()) continue;
    const Quantity& quantity = one.quantities[q];
    const Source& source = list->items[q].source;
    const std::string key = fmt::format("quantity[{}]", q - standard + 1);
    const QuantityKind& kind = *quantity.kind;
    if (const std::string wrong = kind.refusal ? kind.refusal(one, quantity) : ""; !wrong.empty())
      reader.report(source, key, wrong);
    if (const std::string idle = kind.idle ? kind.idle(one, quantity) : ""; !idle.empty())
      reader.warn(source, key, idle);
    const auto course = std::ranges::find(one.quantities, quantity.of, &Quantity::name);
    if (kind.so_far && course != one.quantities.end() && course->kind->so_far)
      reader.report(source, key + ".of",
                    fmt::format("found \"{}\", a {}: a {} is of a quantity that each state has by itself",
                                quantity.of, course->kind->word, kind.word));
    check_step_with_end(reader, one, list->items[q].find("at"), key + ".at", quantity.at);
    check_step_with_end(reader, one, list->items[q].find("since"), key + ".since", quantity.since);
    const auto at = std::ranges::find(one.steps, quantity.at, &Step::name),
               since = std::ranges::find(one.steps, quantity.since, &Step::name);
    if (at < since && since != one.steps.end())
      reader.report(list->items[q].find("at")->source, key + ".at",
                    fmt::format("found \"{}\": that step ends before \"{}\", since which it counts",
                                quantity.at, quantity.since));
  }
  list = tree.find("profile");
  for (std::size_t p = 0; p < one.profiles.size(); ++p) {
    check_step_with_end(reader, one, list->items[p].find("since"), fmt::format("profile[{}].since", p + 1),
                        one.profiles[p].since);
    if (one.profiles[p].kind == ProfileKind::contact_pressure && !one.may_touch(one.profiles[p].of))
      reader.report(list->items[p].source, fmt::format("profile[{}].of", p + 1),
                    fmt::format("found \"{}\": it is neither one of contact.between nor lies on the [table]",
                                one.profiles[p].of));
  }
}

/// A check whose tolerance is larger than its value passes with 0 and with the other sign, too.
void check_tolerances(SectionReader& reader, const Node& tree, const Case& one) {
  for (std::size_t c = 0; c < one.checks.size(); ++c) {
    const Check& check = one.checks[c];
    const Node* written = tree.find("check")->items.at(c).find("tolerance");
    if (check.value == 0 || check.tolerance <= std::abs(check.value) || !written) continue;
    reader.warn(written->source, fmt::format("check[{}].tolerance", c + 1),
                fmt::format("it is {:.3g} times the value: a {} of 0 would pass here; a part of the value is "
                            "written as \"1 %\"",
                            check.tolerance / std::abs(check.value), check.quantity));
  }
}

/// What a controller drives must be there, once.
template<class Report>
void check_driven(const Case& one, const Controller& controller, const Report& report) {
  const DrivenLoad& load = controller.drives;
  const bool in_place = load.what == Driven::force || load.what == Driven::displacement;
  if ((load.what == Driven::pressure || load.what == Driven::volume) && !one.chamber)
    report("drives", "there is no [chamber]");
  if (in_place && !fem::moves(one.dimension, load.along))
    return report("along", "the model does not move along it");
  if (load.what == Driven::force && std::ranges::count_if(one.loads, [&](const Load& own) {
                                      return own.place == load.of && !own.moment;
                                    }) != 1)
    report("place", fmt::format("found \"{}\": it needs one [[load]] with a force on it", load.of));
  if (load.what != Driven::displacement) return;
  const auto holds_it = [&](const Support& own) {
    return own.place == load.of && own.fixed[static_cast<std::size_t>(load.along)];
  };
  const auto holds_while_time_passes = [&](const Support& own) {
    const auto number = static_cast<std::size_t>(&own - one.supports.data());
    return holds_it(own) && holds_in_any(one, number, {StepKind::transient});
  };
  if (std::ranges::none_of(one.supports, holds_it))
    report("place",
           fmt::format("found \"{}\": no [[support]] fixes it along {}", load.of, "xyz"[load.along]));
  else if (has_step(one, {StepKind::transient}) &&
           std::ranges::none_of(one.supports, holds_while_time_passes))
    report("place",
           fmt::format("found \"{}\": no [[support]] holds it in a step of kind \"transient\"", load.of));
  if (std::ranges::any_of(one.steps, &Step::inertia))
    report("drives", "it moves the support by jumps, which need steps without inertia");
}

/// A controller measures states as they are reached, a million times at most.
void check_controllers(SectionReader& reader, const Node& tree, const Case& one) {
  for (std::size_t c = 0; c < one.controllers.size(); ++c) {
    const Controller& controller = one.controllers[c];
    const Node& written = tree.find("controller")->items[c];
    const auto report = [&](const char* key, const std::string& message) {
      const Node* node = written.find(key);
      reader.report(node ? node->source : written.source, fmt::format("controller[{}].{}", c + 1, key),
                    message);
    };
    check_driven(one, controller, report);
    const auto same = [&](const Controller& other) { return other.drives == controller.drives; };
    if (std::ranges::find_if(one.controllers, same) !=
        one.controllers.begin() + static_cast<std::ptrdiff_t>(c))
      report("drives", "another controller drives it already");
    const auto measured = std::ranges::find(one.quantities, controller.quantity, &Quantity::name);
    if (measured != one.quantities.end() && (measured->kind->so_far || measured->kind->of_run))
      report("quantity",
             fmt::format("found \"{}\": a state alone does not tell a {}; measure another quantity",
                         controller.quantity, measured->kind->word));
    for (const Step& step : one.steps)
      if (step.kind == StepKind::transient && *step.duration > Controller::most_samples * controller.every)
        report("every", fmt::format("step \"{}\" would have {:.3g} measurements, allowed {:.0f}", step.name,
                                    *step.duration / controller.every, Controller::most_samples));
  }
}

/// Files are named after steps and columns after quantities: none may take the name of one that is there.
void check_names(SectionReader& reader, const Node& tree, const Case& one) {
  for (std::size_t s = 0; s < one.steps.size(); ++s) {
    const std::string& name = one.steps[s].name;
    const bool taken = name == history_name || name == critical_name ||
                       std::ranges::find(one.profiles, name, profile_name) != one.profiles.end();
    if (!one.steps[s].is_analysis() || !taken) continue;
    const Node& item = tree.find("step")->items.at(s);
    reader.report(item.find("name")->source, fmt::format("step[{}].name", s + 1),
                  fmt::format("found \"{}\": a file of the results has this name; choose another", name));
  }
  const Node* list = tree.find("quantity");
  const std::size_t standard = list ? list->items.size() - written_items(*list) : 0;
  const std::vector<post::Column> columns = history_columns(one);
  for (std::size_t q = 0; list && q < list->items.size(); ++q) {
    const std::string& name = one.quantities[q].name;
    if (list->items[q].source.is_written() && std::ranges::count(columns, name, &post::Column::name) > 1)
      reader.report(list->items[q].find("name")->source, fmt::format("quantity[{}].name", q - standard + 1),
                    fmt::format("found \"{}\": a column of the history has this name; choose another", name));
  }
}

} // namespace

void check_results(SectionReader& reader, const Node& tree, const Case& one) {
  check_quantities(reader, tree, one);
  check_beginnings(reader, tree, one);
  check_tolerances(reader, tree, one);
  check_names(reader, tree, one);
  check_controllers(reader, tree, one);
}

} // namespace dielast::cases
