// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/report_files.hpp"

namespace dielast::post {

void write_report(ResultsFolder& folder, const Report& report) {
  for (const Figure& figure : report.figures()) folder.write(figure.name, figure.svg);
  folder.write("report.html", report.html());
}

} // namespace dielast::post
