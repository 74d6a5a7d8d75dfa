// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/plot.hpp"

#include "post/file_output.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fcntl.h>
#include <set>
#include <spawn.h>
#include <sstream>
#include <string_view>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace dielast::post {

namespace {

constexpr std::string_view style = R"(
set encoding utf8
set border 3 linecolor '#8a94a0'
set tics nomirror out scale 0.6 textcolor '#3a434d'
set grid linecolor '#e4e8ec' linetype 1 linewidth 0.7
set key below horizontal Left reverse textcolor '#3a434d' samplen 2
set autoscale fix
set offsets graph 0.02, graph 0.02, graph 0.05, graph 0.05
)";
constexpr std::array colours{"#2563a8", "#d9622b", "#2e8b57", "#8e4aa8",
                             "#c2283d", "#4a5560", "#b8860b", "#0f8f9c"};

/// Within single quotes gnuplot interprets nothing but the quote itself.
std::string gnuplot_string(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + "'";
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "NaN"; }

bool has_points(const Series& series) {
  for (std::size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i)
    if (std::isfinite(series.x[i]) && std::isfinite(series.y[i])) return true;
  return false;
}

/// Of long series every bunch of neighbours is drawn by its first point and its extremes in x and y: no more
/// can be seen.
std::vector<std::size_t> drawn_points(const Series& series) {
  constexpr std::size_t bunches = 250;
  const std::size_t count = std::min(series.x.size(), series.y.size());
  const std::size_t bunch = std::max<std::size_t>(1, count / bunches);
  std::vector<std::size_t> drawn;
  for (std::size_t first = 0; first < count; first += bunch) {
    const std::size_t end = std::min(first + bunch, count);
    std::set<std::size_t> shown{first, end - 1};
    for (const auto* values : {&series.x, &series.y}) {
      const auto at = [values](std::size_t k) { return values->begin() + static_cast<std::ptrdiff_t>(k); };
      const auto [low, high] = std::minmax_element(at(first), at(end));
      shown.insert({static_cast<std::size_t>(low - values->begin()),
                    static_cast<std::size_t>(high - values->begin())});
    }
    drawn.insert(drawn.end(), shown.begin(), shown.end());
  }
  return drawn;
}

/// NaN for what a logarithmic axis cannot show.
std::vector<double> shown(std::vector<double> values, bool logarithmic) {
  if (logarithmic)
    std::ranges::replace_if(
        values, [](double value) { return !(value > 0); }, NAN);
  return values;
}

constexpr int width = 640, height = 420;
constexpr double letter = 0.58; ///< width of a letter by the size of the font, on average

/// The size of a font in which a text has room; long texts are written small.
int font_size(const std::string& text, int usual, double room) {
  return static_cast<int>(
      std::clamp(room / (letter * static_cast<double>(text.size() + 1)), 7.0, 1.0 * usual));
}

/// In two lines where one would take small letters.
std::string title_command(const std::string& text) {
  constexpr int usual = 16;
  std::string lines = gnuplot_string(text), longer = text;
  if (const std::size_t half = text.find(' ', text.size() / 2);
      font_size(text, usual, width - 40) < usual && half != std::string::npos) {
    lines = gnuplot_string(text.substr(0, half)) + R"(."\n".)" + gnuplot_string(text.substr(half + 1));
    longer = text.substr(0, half);
  }
  return fmt::format("set title {} font ',{}' textcolor '#1d242c'\n", lines,
                     font_size(longer, usual, width - 40));
}

/// Whether the title or the label of the axis says already which curve it is.
bool names_itself(const Plot& plot, const Series& series) {
  return plot.series.size() == 1 && (plot.title == series.label || plot.y_label.starts_with(series.label));
}

/// Room for the key below the axes: the columns that fit in beside each other, and the rows that they make.
struct Key {
  std::size_t columns = 1, rows = 0;

  explicit Key(const Plot& plot) {
    std::size_t longest = 0, entries = 0;
    for (const Series& series : plot.series) {
      if (series.label.empty() || names_itself(plot, series) || !has_points(series)) continue;
      longest = std::max(longest, series.label.size());
      ++entries;
    }
    columns = std::max<std::size_t>(
        1, static_cast<std::size_t>(width / (14 * letter * static_cast<double>(longest) + 60)));
    rows = (entries + columns - 1) / columns;
  }
};

int height_of(const Plot& plot) { return height + static_cast<int>(22 * Key(plot).rows); }

/// Smallest and largest of the finite values; crossed where there are none.
std::pair<double, double> ends(const std::vector<Series>& all, std::vector<double> Series::*values) {
  std::pair<double, double> found{INFINITY, -INFINITY};
  for (const Series& series : all)
    for (const double value : series.*values)
      if (std::isfinite(value)) found = {std::min(found.first, value), std::max(found.second, value)};
  return found;
}

/// A digit times a power of ten as it is written in print.
std::string tick_label(int times, int exponent) {
  if (exponent >= -2 && exponent <= 4)
    return fmt::format("{:.{}f}", times * std::pow(10, exponent), std::max(0, -exponent));
  constexpr std::array superscripts{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = times == 1 ? "10" : fmt::format("{}·10", times);
  if (exponent < 0) text += "⁻";
  for (const char digit : std::to_string(std::abs(exponent)))
    text += superscripts[static_cast<std::size_t>(digit - '0')];
  return text;
}

/// 1, 2 or 5 times a power of ten, about as large as `raw`.
double round_step(double raw) {
  const double decade = std::pow(10, std::floor(std::log10(raw)));
  return decade * (raw < 1.5 * decade ? 1 : raw < 3 * decade ? 2 : raw < 7 * decade ? 5 : 10);
}

/// Digits that tell the ticks of an axis apart: more than usual where it shows a small part of a large
/// number.
int digits_of(std::pair<double, double> range) {
  const auto [low, high] = range;
  constexpr int usual = 6, most = 15;
  if (!(high > low)) return usual;
  const double size = std::max(std::abs(low), std::abs(high));
  return std::clamp(static_cast<int>(std::ceil(std::log10(size / (high - low)))) + 3, usual, most);
}

/// Ticks of a logarithmic axis: powers of ten; within two decades 2 and 5 between them, too; on a shorter
/// axis as many as on a linear one, without which it might have a single label. Values that only rounding
/// tells apart have none of their own: counting ticks in steps as small would not come forward.
std::string logarithmic_ticks(char axis, std::pair<double, double> range) {
  const auto [low, high] = range;
  if (!(high > low)) return fmt::format("set {}tics autofreq\n", axis);
  if (!(high > low * (1 + 1e-12))) // gnuplot refuses an axis as short
    return fmt::format("set {0}tics autofreq\nset {0}range [{1}:{2}]\n", axis, number(0.99 * low),
                       number(1.01 * high));
  std::string ticks;
  const auto add = [&](const std::string& label, double value) {
    ticks += fmt::format("{}{} {:.15g}", ticks.empty() ? "" : ", ", gnuplot_string(label), value);
  };
  if (high < 4 * low) {
    const double step = round_step((high - low) / 4);
    for (double k = std::ceil(low / step - 1e-9); k * step <= high * (1 + 1e-12); ++k)
      add(fmt::format("{:.{}g}", k * step, digits_of(range)), k * step);
  } else {
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high)));
    const int every = 1 + (last - first) / 9;
    for (int exponent = first; exponent <= last; exponent += every)
      for (const int times : {1, 2, 5})
        if (times == 1 || high < 100 * low) add(tick_label(times, exponent), times * std::pow(10, exponent));
  }
  return fmt::format("set {}tics ({})\n", axis, ticks);
}

constexpr std::string_view axes_mark = "axes of the plot above:";

std::string script(const Plot& plot) {
  std::string data, curves;
  std::vector<Series> drawn;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    Series series = plot.series[i];
    series.x = shown(std::move(series.x), plot.log_x);
    series.y = shown(std::move(series.y), plot.log_y);
    if (!has_points(series)) continue;
    data += fmt::format("$series{} << END\n", i);
    for (const std::size_t k : drawn_points(series))
      data += number(series.x[k]) + " " + number(series.y[k]) + "\n";
    data += "END\n";
    const char* with = series.style == Series::Style::line     ? "lines"
                       : series.style == Series::Style::points ? "points"
                                                               : "linespoints";
    const bool untitled = series.label.empty() || names_itself(plot, series);
    curves += fmt::format("{}$series{} using 1:2 with {} linecolor '{}' linewidth 1.4 {} {} {}",
                          curves.empty() ? "" : ", ", i, with, colours[i % colours.size()],
                          series.style == Series::Style::points ? "" : fmt::format("dashtype {}", 1 + i % 4),
                          series.style == Series::Style::line ? "" : "pointtype 7 pointsize 0.55",
                          untitled ? "notitle" : "title " + gnuplot_string(series.label));
    drawn.push_back(std::move(series));
  }
  // With nothing to draw gnuplot would stop: show the empty axes.
  if (curves.empty()) curves = "[1:2] [1:2] NaN notitle";
  const Key key(plot);
  std::string settings =
      fmt::format("set terminal svg size {},{} noenhanced rounded linewidth 1.4 font 'Helvetica,Arial,DejaVu "
                  "Sans,sans-serif,14' background '#ffffff'\nset key maxcols {} title ' ' font ',5'\n",
                  width, height_of(plot), key.columns);
  settings += title_command(plot.heading.empty() ? plot.title : plot.heading);
  settings += fmt::format("set xlabel {} font ',{}' textcolor '#3a434d' offset 0,0.4\n",
                          gnuplot_string(plot.x_label), font_size(plot.x_label, 14, width - 120));
  settings += fmt::format("set ylabel {} font ',{}' textcolor '#3a434d'\n", gnuplot_string(plot.y_label),
                          font_size(plot.y_label, 14, height - 80));
  settings += fmt::format("set format x '%.{}g'\nset format y '%.{}g'\n", digits_of(ends(drawn, &Series::x)),
                          digits_of(ends(drawn, &Series::y)));
  const auto [lowest, highest] = ends(drawn, &Series::y);
  const auto [leftmost, rightmost] = ends(drawn, &Series::x);
  const double extent = std::max(highest - lowest, rightmost - leftmost);
  const auto range = [&plot](char axis, double first, double last) {
    const double middle = (first + last) / 2, half = plot.least_extent / 2;
    return last - first < plot.least_extent
               ? fmt::format("set {}range [{:.17g}:{:.17g}]\n", axis, middle - half, middle + half)
               : fmt::format("set {}range [*:*]\n", axis);
  };
  settings += range('x', leftmost, rightmost) + range('y', lowest, highest);
  settings += plot.log_x ? logarithmic_ticks('x', ends(drawn, &Series::x)) : "set xtics autofreq\n";
  settings += plot.log_y ? logarithmic_ticks('y', ends(drawn, &Series::y))
              : plot.y_step > 0 && highest - lowest > 2 * plot.y_step
                  ? fmt::format("set ytics {}\n", plot.y_step)
                  : "set ytics autofreq\n";
  if (plot.equal_axes && extent > 0 && std::isfinite(extent)) // labels have room where it is the shorter one
    settings += fmt::format("set xtics {}\n", round_step(extent / 6));
  settings += fmt::format("unset logscale\n{}{}set size {}\n", plot.log_x ? "set logscale x\n" : "",
                          plot.log_y ? "set logscale y\n" : "", plot.equal_axes ? "ratio -1" : "noratio");
  // Where the axes are: px from the lower left corner, then their ends.
  return fmt::format(
      "{}{}plot {}\nunset output\nset print '-'\nprint sprintf('{} %g %g %g %g %.15g %.15g %.15g "
      "%.15g', GPVAL_TERM_XMIN, GPVAL_TERM_XMAX, GPVAL_TERM_YMIN, GPVAL_TERM_YMAX, GPVAL_X_MIN, "
      "GPVAL_X_MAX, GPVAL_Y_MIN, GPVAL_Y_MAX)\n",
      data, settings, curves, axes_mark);
}

/// What gnuplot prints for a script; empty when it cannot be run.
std::string run_gnuplot(std::string_view commands) {
  // The script is a file in memory, so that both ends of a pipe can never wait for each other.
  const int input = ::memfd_create("plot", MFD_CLOEXEC);
  std::array<int, 2> output{};
  if (input < 0 || ::pipe2(output.data(), O_CLOEXEC) != 0) return {};
  write_all(input, commands, "plot script");
  ::lseek(input, 0, SEEK_SET);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output[1], STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  // In a group of its own: an interrupt from the terminal is for this process alone.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::array<char*, 3> arguments{const_cast<char*>("gnuplot"), const_cast<char*>("--default-settings"),
                                 nullptr};
  pid_t child = 0;
  const bool started = posix_spawnp(&child, "gnuplot", &actions, &attributes, arguments.data(), environ) == 0;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  ::close(input);
  ::close(output[1]);

  std::string result;
  std::array<char, 65536> buffer;
  for (ssize_t n = 0;
       started && ((n = ::read(output[0], buffer.data(), buffer.size())) > 0 || (n < 0 && errno == EINTR));)
    if (n > 0) result.append(buffer.data(), static_cast<std::size_t>(n));
  ::close(output[0]);
  while (started && ::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  return result;
}

/// Numbers for a reader: what is not finite is null.
nlohmann::json json_of(const std::vector<double>& values, const std::vector<std::size_t>& places) {
  nlohmann::json array = nlohmann::json::array();
  for (const std::size_t k : places)
    array.push_back(std::isfinite(values[k])
                        ? nlohmann::json(std::strtod(fmt::format("{:.7g}", values[k]).c_str(), nullptr))
                        : nlohmann::json(nullptr));
  return array;
}

/// What a page reads off a plot, see report_script(); `axes` is what gnuplot said of them. Empty where it
/// said nothing that can be used.
std::string readings_of(const Plot& plot, const std::string& axes) {
  std::istringstream numbers(axes);
  std::array<double, 8> n{};
  for (double& number : n)
    if (!(numbers >> number)) return {};
  const int below = height_of(plot);
  nlohmann::json series = nlohmann::json::array();
  for (const Series& one : plot.series) {
    if (!has_points(one)) continue;
    const std::vector<std::size_t> drawn = drawn_points(one);
    series.push_back({{"label", names_itself(plot, one) ? "" : one.label},
                      {"x", json_of(shown(one.x, plot.log_x), drawn)},
                      {"y", json_of(shown(one.y, plot.log_y), drawn)}});
  }
  const nlohmann::json readings{{"size", {width, below}},
                                {"frame", {n[0], n[1], below - n[3], below - n[2]}},
                                {"x", {{"ends", {n[4], n[5]}}, {"log", plot.log_x}, {"label", plot.x_label}}},
                                {"y", {{"ends", {n[6], n[7]}}, {"log", plot.log_y}, {"label", plot.y_label}}},
                                {"series", series}};
  return readings.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

std::vector<Image> draw(const std::vector<Plot>& plots) {
  std::string commands(style);
  for (const Plot& plot : plots) commands += script(plot);
  const std::string output = plots.empty() ? std::string() : run_gnuplot(commands);

  constexpr std::string_view opening = "<?xml";
  std::vector<Image> images;
  for (std::size_t begin = output.find(opening); begin != std::string::npos;) {
    const std::size_t end = output.find(opening, begin + opening.size());
    const std::string document = output.substr(begin, end - begin);
    const std::size_t axes = std::min(document.rfind(axes_mark), document.size());
    Image& image = images.emplace_back(Image{document.substr(0, axes)});
    if (images.size() <= plots.size() && axes < document.size()) {
      const Plot& plot = plots[images.size() - 1];
      image.name = plot.title.empty() ? plot.y_label : plot.title;
      image.readings = readings_of(plot, document.substr(axes + axes_mark.size()));
    }
    begin = end;
  }
  // A missing one cannot be told from its neighbours, so none is safe to show.
  if (images.size() != plots.size()) images.clear();
  return images;
}

} // namespace dielast::post
