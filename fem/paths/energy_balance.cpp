// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/paths/energy_balance.hpp"

#include <algorithm>
#include <cmath>

namespace dielast::fem {

namespace {

/// Changes below this part of a value are its rounding.
constexpr double rounding = 1e-12;
/// Part by which two rules for the heat of dashpots may differ for the one of higher order to be better, and
/// how much better it then is.
constexpr double agreement = 0.1, one_order = 1.0 / 3;
/// Of stored energies, relative, as many increments add it up.
constexpr double round_off = 1e-9;
/// Of the energy of displacements as large as the model: what rounding makes of a device at rest.
constexpr double nothing = 1e-14;
/// Increments that are longer than this many times the one before know no curvature.
constexpr double most_growth = 2.5;

double total(const EnergyParts& parts) {
  return parts.elastic + parts.branches + parts.electric + parts.kinetic;
}

/// The integral of a force over an increment.
struct Integral {
  double value = 0;
  double curvature = 0; ///< part of it that the trapezoidal rule does not see
  double range = 0;     ///< sum of |change of force| |change of coordinate|: 0 where that rule is exact
};

/// From one accepted state to the next.
class Interval {
 public:
  Interval(const std::vector<EnergyPoint>& points, const EnergyPoint& end)
      : before_(points.size() > 1 && end.length > 0 && end.length <= most_growth * points.back().length
                    ? &points.front()
                    : nullptr),
        begin_(points.back()), end_(end) {
    const double h = end.length, h1 = begin_.length;
    if (before_) weight_ = h * h / (6 * h1 * (h1 + h));
  }

  double duration() const { return end_.time - begin_.time; }
  Integral over(Conjugates EnergyPoint::*pair) const {
    return over([pair](const EnergyPoint& point) -> const Conjugates& { return point.*pair; });
  }
  /// Of one of the pairs.
  Integral over(Conjugates EnergyPoint::*pair, Eigen::Index i) const {
    return over([pair, i](const EnergyPoint& point) {
      return Conjugates{(point.*pair).force.segment(i, 1), (point.*pair).coordinate.segment(i, 1)};
    });
  }
  /// Change of the drop from an electrode's source over that of its voltage, at most 1 either way.
  double drop_over_voltage(Eigen::Index e) const {
    const double volts = end_.electrical.force[e] - begin_.electrical.force[e];
    return std::clamp((end_.resistance.force[e] - begin_.resistance.force[e]) / volts, -1.0, 1.0);
  }
  /// Of resistances times the squares of the rates of charges, which need time.
  double over_rates(const Eigen::VectorXd& resistances) const {
    const double h = duration(), h1 = before_ ? begin_.time - before_->time : 0;
    double result = 0;
    for (Eigen::Index i = 0; i < resistances.size(); ++i) {
      const double now = end_.resistance.coordinate[i], then = begin_.resistance.coordinate[i],
                   rate = (now - then) / h;
      result += resistances[i] * h * rate * rate;
      if (!(h1 > 0)) continue;
      const double change = 2 * (rate - (then - before_->resistance.coordinate[i]) / h1) / (h + h1);
      result += resistances[i] * h * h * h * change * change / 12; // parabola through three states
    }
    return result;
  }
  Integral over(EnergyPoint::Power power) const {
    return over([power](const EnergyPoint& point) {
      return Conjugates{Eigen::VectorXd::Constant(1, point.power[power]),
                        Eigen::VectorXd::Constant(1, point.time)};
    });
  }

 private:
  static double changed(double from, double to) {
    const double change = std::abs(to - from);
    return change > rounding * std::max(std::abs(from), std::abs(to)) ? change : 0;
  }
  template<class Pair>
  Integral over(const Pair& pair) const {
    const Conjugates &a = pair(begin_), &b = pair(end_);
    const Eigen::VectorXd force = b.force - a.force, way = b.coordinate - a.coordinate;
    Integral result{(a.force + b.force).dot(way) / 2};
    for (Eigen::Index i = 0; i < way.size(); ++i)
      result.range += changed(a.force[i], b.force[i]) * changed(a.coordinate[i], b.coordinate[i]);
    if (before_) { // parabolas through three states
      const Conjugates& p = pair(*before_);
      result.curvature = weight_ * ((a.force - p.force).dot(way) - force.dot(a.coordinate - p.coordinate));
      result.value += result.curvature;
    }
    return result;
  }

  const EnergyPoint* before_;
  const EnergyPoint& begin_;
  const EnergyPoint& end_;
  double weight_ = 0;
};

} // namespace

/// What a source gives, J, beyond its work while its voltage leads the charge of a sheet's terminal, where it
/// stands at its new voltage at once.
double EnergyBalance::given_at_jump(const EnergyPoint& point) const {
  const EnergyPoint& last = record_.points.back();
  double given = 0;
  if (point.time > last.time || point.sheet.coordinate != last.sheet.coordinate) return given;
  const Conjugates &from = last.electrical, &to = point.electrical;
  for (Eigen::Index e = 0; e < point.at_source.size(); ++e)
    given += point.at_source[e] * (to.force[e] - from.force[e]) *
             ((from.coordinate[e] + to.coordinate[e]) / 2 - record_.before_jump[e]);
  return given;
}

void EnergyBalance::account(const EnergyPoint& point, bool is_cut) {
  const Interval interval(record_.points, point);
  const Integral electrical = interval.over(&EnergyPoint::electrical);
  Integral mechanical = interval.over(&EnergyPoint::mechanical);
  mechanical.value += point.impulses;
  const double change = total(point.energy) - stored();
  double heat = point.friction - record_.points.back().friction, through_sheet = given_at_jump(point),
         doubt = 0, doubt_of_circuits = 0;
  heat += through_sheet;
  const bool flows = point.flow != 0 || point.sheet.coordinate != record_.points.back().sheet.coordinate;
  if (interval.duration() > 0) {
    const Integral resisted = interval.over(&EnergyPoint::resistance);
    const Integral flow = interval.over(EnergyPoint::dashpots);
    const bool fine = std::abs(flow.value - point.flow) <= agreement * point.flow;
    const Integral damped = interval.over(EnergyPoint::dampers);
    const Integral conducted = interval.over(&EnergyPoint::sheet);
    const Integral leaked = interval.over(EnergyPoint::leak);
    const double leak_through_sheet = interval.over(EnergyPoint::leak_through_sheet).value;
    through_sheet += leak_through_sheet;
    heat += (fine ? flow.value : std::max(0.0, point.flow)) + std::max(0.0, damped.value) +
            std::max(0.0, conducted.value + leak_through_sheet);
    record_.work.resistance +=
        std::max(0.0, resisted.value + interval.over(EnergyPoint::leak_through_resistance).value +
                          interval.over_rates(point.given_through));
    record_.work.leak += std::max(0.0, leaked.value);
    doubt = std::abs(flow.value - point.flow) * (fine ? one_order : 1) + std::abs(damped.curvature) +
            std::abs(conducted.curvature);
    doubt_of_circuits = std::abs(resisted.curvature) + std::abs(leaked.curvature);
  }
  Work& work = record_.work;
  const double rest = change + heat - electrical.value - through_sheet - mechanical.value;
  const double range = electrical.range + mechanical.range;
  double electrical_share = 0, mechanical_share = 0;
  if (is_cut) {
    work.released -= rest;
  } else if (point.moves) {
    record_.rest += rest;
  } else if (range > 0 && !point.flowed) {
    electrical_share = rest * electrical.range / range;
    mechanical_share = rest * mechanical.range / range;
    if (electrical.range > 0 && mechanical.range > 0) doubt += std::abs(rest);
  } else if (!flows && !point.flowed) {
    record_.rest += rest;
  } else {
    const double taken = std::max(-heat, -rest);
    heat += taken;
    record_.rest += rest + taken;
  }
  if (!(interval.duration() > 0)) {
    // Charge goes back only to a source that has come down to the electrode's voltage: slowly, without heat.
    // Where a source stays the drop from it loses what the electrode gains, in its share of the rest, too.
    for (Eigen::Index e = 0; e < point.resistance.force.size(); ++e) {
      if (e < point.given_through.size() && point.given_through[e] > 0)
        continue; // a charge that is given at once: by no certain current
      const Integral resisted = interval.over(&EnergyPoint::resistance, e);
      const double own = interval.over(&EnergyPoint::electrical, e).range;
      const double share =
          own > 0 ? electrical_share * own / electrical.range * interval.drop_over_voltage(e) : 0;
      work.resistance += std::max(0.0, resisted.value + share);
      doubt_of_circuits += std::abs(resisted.curvature);
    }
  }
  work.electrical += electrical.value + through_sheet + electrical_share;
  work.mechanical += mechanical.value + mechanical_share;
  work.dissipated += heat;
  record_.doubt += doubt;
  record_.doubt_of_circuits += doubt_of_circuits;
}

/// Keeps the point, and what it says of the energies so far.
void EnergyBalance::arrive(EnergyPoint point) {
  auto& points = record_.points;
  if (points.empty()) record_.stored_at_start = total(point.energy);
  const bool jumps = !points.empty() && point.time <= points.back().time;
  if (points.size() == 2) points.erase(points.begin());
  points.push_back(std::move(point));
  if (!jumps) stand();
  const Work& work = record_.work;
  // What is known no better than to itself has not been exchanged for certain.
  const double unknown = error() - record_.doubt_of_circuits, taken = stored() - record_.stored_at_start;
  const auto note = [&](double cut, double& exchanged) {
    for (const double energy :
         {work.electrical, work.mechanical, work.dissipated, work.released - cut, taken + cut})
      if (std::abs(energy) > 2 * unknown) exchanged = std::max(exchanged, std::abs(energy));
  };
  note(0, record_.exchanged);
  note(record_.cut, record_.without_cuts);
  record_.given = std::max(record_.given, record_.exchanged);
  for (const double energy : {work.resistance, work.leak})
    if (energy > 2 * error()) record_.given = std::max(record_.given, energy);
}

void EnergyBalance::add(EnergyPoint point) {
  if (!empty()) account(point);
  arrive(std::move(point));
}

void EnergyBalance::corner() {
  auto& points = record_.points;
  if (points.size() == 2) points.erase(points.begin());
  stand();
}

void EnergyBalance::stand() {
  if (!empty()) record_.before_jump = record_.points.back().electrical.coordinate;
}

EnergyBalance::JumpRelease EnergyBalance::add_after_jump(EnergyPoint point) {
  JumpRelease release;
  const auto done = [&](Conjugates EnergyPoint::*pair) {
    const Conjugates &from = record_.points.back().*pair, &to = point.*pair;
    const Eigen::ArrayXd moved = to.coordinate - from.coordinate;
    release.doubt += ((to.force - from.force).array() * moved).abs().sum() / 2;
    return ((from.force + to.force).array() * moved).sum() / 2;
  };
  const double electrical = done(&EnergyPoint::electrical), mechanical = done(&EnergyPoint::mechanical);
  record_.work.electrical += electrical;
  record_.work.mechanical += mechanical;
  release.energy = electrical + mechanical - (total(point.energy) - stored());
  record_.work.released += release.energy;
  record_.points.clear();
  arrive(std::move(point));
  return release;
}

void EnergyBalance::add_cut_free(EnergyPoint point) {
  const double released = record_.work.released;
  account(point, true);
  record_.cut += record_.work.released - released;
  arrive(std::move(point));
}

void EnergyBalance::reconnect(const EnergyPoint& point) {
  EnergyPoint& last = record_.points.back();
  last.resistance = point.resistance;
  last.power = point.power;
  corner();
}

double EnergyBalance::stored() const { return empty() ? 0 : total(parts()); }

double EnergyBalance::error() const {
  return record_.doubt + record_.doubt_of_circuits + std::abs(record_.rest);
}

void EnergyBalance::judge(double scale, int row, int step) {
  const EnergyParts& parts = this->parts();
  // Differences of stored energies are no better known than these.
  const double known = round_off * (std::abs(parts.elastic) + std::abs(parts.branches) +
                                    std::abs(parts.electric) + std::abs(record_.stored_at_start)) +
                       nothing * scale;
  const double of_circuits = record_.doubt_of_circuits;
  for (const bool given : {false, true}) {
    const Resolution now{std::max(0.0, error() - known - (given ? 0 : of_circuits)),
                         given ? record_.given : record_.without_cuts,
                         given,
                         error(),
                         row,
                         step};
    // What was exchanged never falls: a result before this one that is not worse can never be the worst
    // again.
    std::erase_if(record_.poor, [&](const Resolution& former) {
      return !weighed(former).is_poor() || (former.given == given && former.error <= now.error &&
                                            former.error * now.exchanged <= now.error * former.exchanged);
    });
    if (now.is_poor()) record_.poor.push_back(now);
  }
}

EnergyBalance::Resolution EnergyBalance::weighed(const Resolution& result) const {
  constexpr double least = 1e-3;
  Resolution beside = result;
  beside.exchanged = std::max(result.exchanged, least * (result.given ? record_.given : record_.exchanged));
  return beside;
}

EnergyBalance::Resolution EnergyBalance::worst() const {
  Resolution worst{0, record_.exchanged};
  for (const Resolution& result : record_.poor) {
    const Resolution here = weighed(result);
    // One that has exchanged nothing for certain is worse than any but another such one.
    if (worst.error == 0 || here.error * worst.exchanged > worst.error * here.exchanged) worst = here;
  }
  return worst;
}

} // namespace dielast::fem
