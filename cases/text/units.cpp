// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/text/units.hpp"

#include <fmt/format.h>
#include <udunits2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <clocale>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <vector>

namespace dielast::cases {
namespace {

using Unit = std::unique_ptr<ut_unit, decltype(&ut_free)>;
using Converter = std::unique_ptr<cv_converter, decltype(&cv_free)>;

/// udunits' parser has global state.
std::mutex parser_mutex;

Unit parsed(ut_system* system, const std::string& text) {
  return {ut_parse(system, text.c_str(), UT_UTF8), &ut_free};
}

/// udunits reads and writes numbers as the locale has them: while this lives, the thread's has a decimal
/// point.
class DecimalPoint {
 public:
  DecimalPoint() {
    static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
    before_ = uselocale(plain);
  }
  ~DecimalPoint() { uselocale(before_); }
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;

 private:
  locale_t before_;
};

/// The units database, read once; "deg" is added since engineers write it and udunits knows only "degree".
ut_system* unit_system() {
  static ut_system* const system = [] {
    ut_set_error_message_handler(ut_ignore);
    ut_system* read = ut_read_xml(nullptr);
    if (read == nullptr) throw std::runtime_error("the database of udunits cannot be read; is it installed?");
    const Unit degree = parsed(read, "degree");
    ut_map_name_to_unit("deg", UT_UTF8, degree.get());
    return read;
  }();
  return system;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t";
  const auto first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Units that exist and that hardly anybody means.
struct Misread {
  std::string_view unit, is, meant;
};
constexpr std::array misread{Misread{"gr", "a grain", "g"}, Misread{"mgr", "a thousandth of a grain", "mg"},
                             Misread{"kgr", "a thousand grains", "kg"},
                             Misread{"ct", "a hundredth of a tonne", "carat"},
                             Misread{"mPa", "a thousandth of a pascal", "MPa"}};

/// Throws UnitError where one of them stands in `unit`; "mPa" alone, as viscosities have it.
void require_meant(const std::string& unit) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";
  for (std::size_t begin = unit.find_first_of(letters); begin != std::string::npos;) {
    const std::size_t end = std::min(unit.find_first_not_of(letters, begin), unit.size());
    const std::string_view name = std::string_view(unit).substr(begin, end - begin);
    const auto found = std::ranges::find(misread, name, &Misread::unit);
    if (found != misread.end() && (name != "mPa" || name == unit))
      throw UnitError(fmt::format("with the unit \"{}\", which is {} (did you mean \"{}\"?)", name, found->is,
                                  found->meant));
    begin = unit.find_first_of(letters, end);
  }
}

/// To udunits a radian is 1: the factor that it leaves out where an angle per time (rad/s, rpm) stands for a
/// frequency, or the other way round. "1/s" is taken for either.
double factor_left_out(const std::string& unit, std::string_view wanted) {
  const bool wants_angle = wanted == "rad/s";
  if (!wants_angle && wanted != "Hz") return 1;
  constexpr double turn = 2 * std::numbers::pi;
  const bool is_angle = si_unit(unit).powers.back() != 0; // of rad
  if (!wants_angle) return is_angle ? 1 / turn : 1;
  return !is_angle && (unit.find("Hz") != std::string::npos || unit.find("ertz") != std::string::npos) ? turn
                                                                                                       : 1;
}

/// Factor from `unit` to `si_unit`. Reciprocals, offsets (celsius), logarithms and dates also "convert" in
/// udunits: only a linear map is a unit of the same dimension.
double factor_to_si(const std::string& unit, std::string_view si_unit) {
  require_meant(unit);
  const double left_out = factor_left_out(unit, si_unit);
  const std::lock_guard lock(parser_mutex);
  const DecimalPoint decimal_point;
  const Unit from = parsed(unit_system(), unit), to = parsed(unit_system(), std::string(si_unit));
  if (!from) throw UnitError(fmt::format("with the unknown unit \"{}\"", unit), unit);
  const Converter converter{ut_get_converter(from.get(), to.get()), &cv_free};
  const auto convert = [&](double value) { return cv_convert_double(converter.get(), value); };
  if (!converter || convert(0.0) != 0.0 || std::abs(convert(2.0) - 2.0 * convert(1.0)) > 1e-12 * convert(2.0))
    throw UnitError(unit.empty() ? "without a unit"
                                 : fmt::format("whose unit \"{}\" is of another kind", unit));
  return convert(1.0) * left_out;
}

/// The number whose decimal digits stand so many places further: "2.9 cm" is "29 mm" to the last bit.
double shifted(double number, int places) {
  std::array<char, 40> digits{};
  const char* const end =
      std::to_chars(digits.data(), digits.data() + digits.size(), number, std::chars_format::scientific).ptr;
  const char* const exponent = std::find(static_cast<const char*>(digits.data()), end, 'e');
  int power = 0; // behind "e+", which from_chars() does not read, or "e-"
  std::from_chars(exponent + (exponent[1] == '+' ? 2 : 1), end, power);
  const std::string text = fmt::format(
      "{}e{}", std::string_view(digits.data(), static_cast<std::size_t>(exponent - digits.data())),
      power + places);
  double value = 0;
  const bool fits = std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{};
  return fits ? value : number * std::pow(10.0, places);
}

/// Factors are powers of ten or whole numbers up to round-off.
double scaled(double number, double factor) {
  const double places = std::round(std::log10(factor));
  if (number != 0 && std::abs(factor / std::pow(10.0, places) - 1.0) < 1e-14)
    return shifted(number, static_cast<int>(places));
  const double whole = std::round(factor), parts = std::round(1.0 / factor);
  constexpr double round_off = 1e-14;
  if (whole >= 1 && std::abs(factor / whole - 1.0) < round_off) return number * whole;
  if (parts >= 1 && std::abs(factor * parts - 1.0) < round_off) return number / parts;
  return number * factor;
}

} // namespace

std::span<const Dimension> dimensions() {
  static constexpr std::array table{
      Dimension{"1", "a number", "0.5", 1e6, "1", "%"},
      Dimension{"m", "a length", "1 mm", 10, "m", "um mm cm m inch"},
      Dimension{"rad", "an angle", "150 deg", 6.283185307179586, "deg", "deg rad"},
      Dimension{"s", "a time", "1 s", 1e10, "s", "ms s min h"},
      Dimension{"1/s", "a rate", "0.01 1/s", 1e9, "1/s", "1/s 1/min"},
      Dimension{"Hz", "a frequency", "1 Hz", 1e9, "Hz", "mHz Hz kHz"},
      Dimension{"Pa", "a pressure or modulus", "45 kPa", 1e13, "kPa", "Pa kPa MPa GPa N/mm^2 bar psi"},
      Dimension{"Pa s", "a viscosity", "1e7 Pa.s", 1e15, "Pa s", "Pa.s kPa.s MPa.s"},
      Dimension{"N", "a force", "5 mN", 1e6, "N", "uN mN N kN"},
      Dimension{"N/m", "a stiffness", "180 N/m", 1e9, "N/m", "N/m N/mm"},
      Dimension{"kg", "a mass", "100 g", 1e6, "g", "mg g kg"},
      Dimension{"N s/m", "a damping", "1.6 N.s/m", 1e9, "N s/m", "N.s/m mN.s/m"},
      Dimension{"m/s^2", "an acceleration", "9.81 m/s^2", 1e6, "m/s^2", "m/s^2"},
      Dimension{"m^2", "an area", "10 mm^2", 1e3, "m^2", "mm^2 cm^2 m^2"},
      Dimension{"m^3", "a volume", "10 ml", 1e3, "m^3", "mm^3 cm^3 ml l m^3"},
      Dimension{"rad/s", "an angular frequency", "40 rad/s", 1e10, "rad/s", "rad/s"},
      Dimension{"1/s^2", "a squared angular frequency", "100 1/s^2", 1e20, "1/s^2", "1/s^2"},
      Dimension{"Ohm", "a resistance", "2 MOhm", 1e18, "Ohm", "Ohm kOhm MOhm GOhm"},
      Dimension{"A", "a current", "1 mA", 1e6, "A", "uA mA A"},
      Dimension{"V", "a voltage", "5 kV", 1e6, "V", "V kV"},
      Dimension{"V/m", "an electric field", "100 MV/m", 1e10, "MV/m", "V/m MV/m V/um kV/mm"},
      Dimension{"F", "a capacitance", "1 nF", 1, "F", "pF nF uF F"},
      Dimension{"C", "a charge", "1 uC", 1, "C", "nC uC mC C"},
      Dimension{"F/m", "a permittivity", "4e-11 F/m", 1e-6, "F/m", "F/m pF/m"},
      Dimension{"J", "an energy", "1 mJ", 1e6, "J", "uJ mJ J kJ"},
      Dimension{"kg m^2", "a moment of inertia", "40 g.mm^2", 1e6, "kg m^2", "g.mm^2 g.cm^2 kg.m^2"},
      Dimension{"N m", "a moment", "1 mN m", 1e6, "N m", "mN.m N.m"},
      Dimension{"1/m", "a curvature", "10 1/m", 1e9, "1/m", "1/m 1/mm"},
      Dimension{"kg/m^3", "a density", "960 kg/m^3", 1e5, "kg/m^3", "kg/m^3 g/cm^3"},
  };
  return table;
}

const Dimension& dimension(std::string_view unit) {
  for (const Dimension& candidate : dimensions())
    if (candidate.unit == unit) return candidate;
  throw std::logic_error(fmt::format("no dimension has the SI unit \"{}\"", unit));
}

namespace {

/// udunits would take "1 2 mm" for 1 x (2 mm), "1 1/2 mm" for 1 x 1/2 mm, and "1 mm 2" for 2 mm: digits in a
/// unit are exponents, but for the 1 of "1/s".
void require_one_number(const std::string& unit) {
  constexpr std::string_view digits = "0123456789", before = "0123456789^+-";
  const bool is_reciprocal =
      unit.starts_with("1/") && unit.size() > 2 && digits.find(unit[2]) == std::string::npos;
  if (!unit.empty() && !is_reciprocal &&
      std::string_view("0123456789.+-*/^(),").find(unit[0]) != std::string_view::npos)
    throw UnitError(fmt::format("with \"{}\" after the number", unit));
  for (std::size_t i = 1; i < unit.size(); ++i)
    if (digits.find(unit[i]) != std::string::npos && before.find(unit[i - 1]) == std::string::npos &&
        std::isalpha(static_cast<unsigned char>(unit[i - 1])) == 0)
      throw UnitError(fmt::format("with a second number in \"{}\"", unit));
}

} // namespace

WrittenMeasure split_measure(std::string_view text) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  WrittenMeasure written;
  const auto [end, problem] = std::from_chars(rest.data(), rest.data() + rest.size(), written.number);
  if (problem == std::errc::result_out_of_range) throw UnitError("which is too large or too small to store");
  if (problem != std::errc{}) throw UnitError("which does not start with a number");
  if (!std::isfinite(written.number)) throw UnitError("which is not finite");
  written.unit = trimmed(rest.substr(static_cast<std::size_t>(end - rest.data())));
  require_one_number(written.unit);
  return written;
}

Measure parse_measure(std::string_view text, std::string_view si_unit) {
  const auto [number, unit] = split_measure(text);
  const double value = scaled(number, factor_to_si(unit, si_unit));
  if (!std::isfinite(value)) throw UnitError("which is too large or too small to store");
  return {value, unit};
}

std::string format_measure(double value, std::string_view si_unit) {
  const std::string_view shown = dimension(si_unit).shown;
  if (shown == "1") return fmt::format("{}", value);
  if (shown != si_unit) {
    const double factor = factor_to_si(std::string(shown), si_unit);
    std::string text = fmt::format("{:.15g} {}", value / factor, shown);
    if (parse_measure(text, si_unit).value == value) return text;
  }
  return fmt::format("{} {}", value, si_unit);
}

std::string in_unit(double value, const std::string& unit, std::string_view si_unit) {
  return fmt::format("{:.6g}{}{}", value / factor_to_si(unit, si_unit),
                     unit.empty() || unit == "%" ? "" : " ", unit);
}

SiUnit si_unit(const std::string& unit) {
  SiUnit found;
  if (unit.empty()) return found;
  std::string product; // without the number that udunits may write in front
  {
    const std::lock_guard lock(parser_mutex);
    const DecimalPoint decimal_point;
    const Unit parsed_unit = parsed(unit_system(), unit);
    if (!parsed_unit) throw UnitError(fmt::format("with the unknown unit \"{}\"", unit), unit);
    std::array<char, 256> text{};
    if (ut_format(parsed_unit.get(), text.data(), text.size() - 1, UT_ASCII | UT_DEFINITION) < 0)
      throw UnitError(fmt::format("whose unit \"{}\" is of another kind", unit));
    product = text.data();
  }
  if (const std::size_t blank = product.find(' '); blank != std::string::npos) product.erase(0, blank + 1);
  if (product.find_first_not_of("0123456789.e+-") == std::string::npos) product.clear(); // a percentage
  for (std::string_view rest = product; !rest.empty();) {
    const std::string_view part = rest.substr(0, rest.find('.'));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    const std::string_view name = part.substr(0, part.find_first_of("-0123456789"));
    const auto base = std::ranges::find(base_units, name);
    if (base == base_units.end()) throw UnitError(fmt::format("whose unit \"{}\" is of another kind", unit));
    int power = 1;
    std::from_chars(part.data() + name.size(), part.data() + part.size(), power);
    found.powers[static_cast<std::size_t>(base - base_units.begin())] += power;
  }
  found.factor = scaled(1, factor_to_si(unit, product.empty() ? "1" : product));
  return found;
}

std::string name_of_unit(const BasePowers& powers) {
  if (powers == BasePowers{}) return "";
  static const auto known = [] {
    std::vector<std::pair<BasePowers, std::string>> made;
    for (const Dimension& one : dimensions())
      made.emplace_back(si_unit(std::string(one.unit)).powers, one.unit);
    return made;
  }();
  for (const auto& [of, name] : known)
    if (of == powers) return name;
  std::string name;
  for (std::size_t i = 0; i < powers.size(); ++i)
    if (powers[i] != 0) name += fmt::format("{}{}{}", name.empty() ? "" : " ", base_units[i], powers[i]);
  return name;
}

std::optional<WrittenMeasure> written_measure(const std::string& toml) {
  std::string_view text = toml;
  if (text.size() > 1 && (text.front() == '"' || text.front() == '\''))
    text = text.substr(1, text.size() - 2);
  try {
    return split_measure(text);
  } catch (const UnitError&) {
    return std::nullopt;
  }
}

} // namespace dielast::cases
