// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/report.hpp"

#include "post/file_output.hpp"
#include "post/pictures/report_tables.hpp"
#include "tests/post/scratch.hpp"

#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <cmath>

namespace dielast::post::report_test {
namespace {

Report sample_report() {
  Report report{
      .title = "A <b>bold</b> & \"quoted\" title", .subtitle = "it's", .status = {"converged", Tone::good}};
  report.highlights = {{"eps_y", "33.19 %", "± 0.05 %"}};
  report.sections = {{"Results",
                      {quantity_table(std::vector<QuantityRow>{
                           {"eps_x", -0.0352, "1", Ratio::percent, 1e-4, "strain <along> x"},
                           {"max_field", 84.97e6, "V/m", Ratio::plain, {}, "field"}}),
                       Image{"<svg id=\"a\"/>", "plot & more"}, Image{"", "not drawn"},
                       Slides{{"<svg>1</svg>", "<svg>2</svg>"}, "the way there", "{\"range\": [0, 1]}"},
                       Paragraph{"a < b"}, Listing{"1  2\n<3>"}}}};
  report.footer = "dielast 0.1";
  return report;
}

TEST(Report, IsWellFormed) {
  const std::string html = sample_report().html();
  const std::string doctype = "<!DOCTYPE html>\n";
  ASSERT_TRUE(html.starts_with(doctype));
  auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
      vtkXMLUtilities::ReadElementFromString(html.substr(doctype.size()).c_str()));
  ASSERT_NE(root, nullptr);
  EXPECT_STREQ(root->GetName(), "html");
  EXPECT_NE(root->FindNestedElementWithName("body"), nullptr);
}

TEST(Report, NeedsNothingFromOutside) {
  const std::string html = sample_report().html();
  for (const char* outside : {"http:", "https:", "<script ", "fetch(", "XMLHttpRequest", "import(", "<link",
                              "url(", "@import", "<svg"})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  EXPECT_NE(html.find("src=\"data:image/svg+xml;base64,PHN2ZyBpZD0iYSIvPg==\""), std::string::npos);
}

// Without its script the page shows the last of the slides.
TEST(Report, SlidesShowTheLast) {
  const std::string html = sample_report().html();
  EXPECT_NE(html.find("<figure class=\"slides\" data-readings=\"{&quot;range&quot;: [0, 1]}\">"),
            std::string::npos);
  const auto hidden = html.find("hidden=\"hidden\" src=\"data:image/svg+xml;base64,PHN2Zz4xPC9zdmc+"),
             shown = html.find("<img alt=\"the way there\" src=\"data:image/svg+xml;base64,PHN2Zz4yPC9zdmc+");
  EXPECT_NE(hidden, std::string::npos);
  EXPECT_NE(shown, std::string::npos);
  EXPECT_LT(hidden, shown);
}

// The script as a browser reads it: with the page as XML it ends where the section of characters ends.
TEST(Report, TheScriptMayHaveAnyCharacter) {
  const std::string html = sample_report().html();
  const auto begin = html.find("<script>//<![CDATA["), end = html.find("//]]></script>");
  ASSERT_NE(begin, std::string::npos);
  ASSERT_NE(end, std::string::npos);
  const std::string script = html.substr(begin + 8, end - begin - 8);
  EXPECT_EQ(script.find("]]>"), std::string::npos);
  EXPECT_EQ(script.find("</script"), std::string::npos);
  EXPECT_NE(script.find(" < "), std::string::npos);
  EXPECT_NE(script.find("data-readings"), std::string::npos);
}

TEST(Report, FiguresAreFilesOfTheirOwn) {
  Report report{.title = "t"};
  report.sections = {{"S",
                      {Image{.svg = "<svg>1</svg>", .name = "eps_y, 2nd: Mode"},
                       Image{.svg = "<svg>2</svg>", .name = "eps_y 2nd mode (%)"},
                       Image{.svg = "<svg>3</svg>"}, Image{.svg = "", .name = "not drawn"}}}};
  std::vector<std::string> names, texts;
  for (const Figure& figure : report.figures()) {
    names.push_back(figure.name);
    texts.push_back(figure.svg);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"figure_eps_y_2nd_mode.svg", "figure_eps_y_2nd_mode_2.svg"}));
  EXPECT_EQ(texts, (std::vector<std::string>{"<svg>1</svg>", "<svg>2</svg>"}));
}

TEST(Report, EscapesEveryText) {
  const std::string html = sample_report().html();
  for (const char* escaped : {"A &lt;b&gt;bold&lt;/b&gt; &amp; &quot;quoted&quot; title", "it&#39;s",
                              "a &lt; b", "strain &lt;along&gt; x", "plot &amp; more", "1  2\n&lt;3&gt;"})
    EXPECT_NE(html.find(escaped), std::string::npos) << escaped;
}

TEST(Report, LeavesOutWhatCouldNotBeDrawn) {
  EXPECT_EQ(sample_report().html().find("not drawn"), std::string::npos);
}

TEST(Report, LongListingsAreFolded) {
  Report report{.title = "t"};
  report.sections = {{"Short", {Listing{"one\ntwo\n"}}}};
  EXPECT_EQ(report.html().find("<details>"), std::string::npos);
  std::string log;
  for (int i = 0; i < 40; ++i) log += "line\n";
  report.sections = {{"Log", {Listing{log}}}};
  EXPECT_NE(report.html().find("<details><summary>40 lines</summary><pre>line"), std::string::npos);
}

TEST(Report, LeadsToOtherPages) {
  Report report{.title = "t", .part_of = Link{"a <study>", "../report.html"}};
  Cell cell("7");
  cell.link = "point-0007/report.html";
  report.sections = {{"Points", {Table{{"point"}, {{cell}}}}}};
  const std::string html = report.html();
  EXPECT_NE(html.find("part of <a href=\"../report.html\">a &lt;study&gt;</a>"), std::string::npos);
  EXPECT_NE(html.find("<a href=\"point-0007/report.html\">7</a>"), std::string::npos);
}

TEST(Report, AlignsColumnsOfNumbers) {
  const std::string html = sample_report().html();
  EXPECT_NE(html.find("<th class=\"number\">Value</th>"), std::string::npos);
  EXPECT_NE(html.find("<th class=\"number\">Error</th>"), std::string::npos); // "-" is a missing number
  EXPECT_NE(html.find("<th>Quantity</th>"), std::string::npos);
}

TEST(ReportTables, ShowErrorsInTheUnitOfTheValue) {
  const QuantityRow length{"released_length_x", 0.08397, "m", Ratio::plain, 2.1e-5, "length"};
  EXPECT_EQ(with_error(length), "83.970 ± 0.021 mm");
  EXPECT_EQ(with_error({"eps_y", 0.3319, "1", Ratio::percent, {}, ""}), "33.19 %");
  EXPECT_EQ(with_error({"loss", 1.290948, "1", Ratio::plain, 0.0, ""}), "1.2909480 ± < 1.3e-06");
  EXPECT_EQ(with_error({"eps_y", NAN, "1", Ratio::percent, 0.1, ""}), "-");
  const auto row = quantity_table(std::vector{length}).rows.at(0);
  EXPECT_EQ(row[1].text, "83.970");
  EXPECT_EQ(row[2].text, "0.021");
  EXPECT_EQ(row[3].text, "mm");
}

TEST(ReportTables, ChecksSayPassOrFailInWords) {
  const CheckRow passed{"eps_y", 0.33, 0.3319, 0.0033, "1", Ratio::percent, "a paper", true};
  CheckRow failed = passed;
  failed.passed = false;
  const auto rows = check_table(std::vector{passed, failed}).rows;
  EXPECT_EQ(rows[0][0].text, "✓ pass");
  EXPECT_EQ(rows[1][0].text, "✗ FAIL");
  EXPECT_EQ(rows[1][0].tone, Tone::bad);
  EXPECT_EQ(rows[0][4].text, "0.33 %");
}

TEST(ReportTables, EventsAndIncrements) {
  StepRecord calm;
  calm.step = "release";
  StepRecord tense = calm;
  tense.voltages = {-5000, 1000};
  tense.unstable_modes = 1;
  tense.events = {{"wall contact", "cell[2,3]", "the apexes touch"}};
  const std::vector records{calm, tense};
  ASSERT_EQ(event_table(records).rows.size(), 1u);
  EXPECT_EQ(event_table(records).rows[0][3].text, "cell[2,3]");
  const auto rows = increment_table(records).rows;
  EXPECT_EQ(rows[0][6].text, "stable");
  EXPECT_EQ(rows[1][3].text, "-5.000 kV");
  EXPECT_EQ(rows[1][6].tone, Tone::warning);
}

} // namespace
} // namespace dielast::post::report_test
