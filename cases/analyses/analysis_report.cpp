// SPDX-License-Identifier: GPL-3.0-or-later
#include "cases/analyses/analysis_report.hpp"

#include "post/pictures/bode.hpp"

#include <fmt/format.h>

namespace dielast::cases {
namespace {

post::Section modes_section(const Analysis& analysis) {
  post::Table table{{"mode", "frequency [Hz]", "angular frequency [rad/s]"}, {}};
  for (const auto& row : analysis.rows) {
    const bool stable = row[3] > 0;
    table.rows.push_back(
        {post::Cell(fmt::format("{:.0f}", row[0])),
         stable ? post::Cell(fmt::format("{:.6g}", row[1])) : post::Cell("unstable", post::Tone::bad),
         post::Cell(stable ? fmt::format("{:.6g}", row[2]) : "")});
  }
  return {analysis.step, {std::move(table)}};
}

} // namespace

post::Section analysis_section(const Analysis& analysis) {
  if (analysis.kind == StepKind::modes) return modes_section(analysis);
  struct Curve {
    std::string title, label;
    std::size_t column;
  };
  std::vector<post::Plot> plots;
  const std::string& per_volt = analysis.columns[1]; // tilt_x_per_volt[rad/V]
  std::vector<Curve> curves{{analysis.of, "per volt " + per_volt.substr(per_volt.find('[')), 1}};
  const std::size_t count = analysis.driven.size();
  for (std::size_t d = 0; d < count; ++d)
    curves.push_back({count > 1 ? "Voltage at electrode " + analysis.driven[d] : "Voltage at the electrode",
                      "per volt of the source [V/V]", 3 + 2 * d});
  curves.push_back({"Impedance seen by the source", "impedance [Ohm]", 5 + 2 * count});
  for (const Curve& curve : curves) {
    const post::FrequencyResponse response{"", analysis.column(0), analysis.values(curve.column)};
    for (post::Plot& plot : post::bode(curve.title, curve.label, std::span(&response, 1)))
      plots.push_back(std::move(plot));
  }
  post::Section section{analysis.step, {}};
  section.add(post::draw(plots));
  if (section.blocks.empty())
    section.blocks.push_back(post::Paragraph{"No plots: gnuplot is not installed."});
  return section;
}

} // namespace dielast::cases
