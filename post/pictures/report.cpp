// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/report.hpp"

#include "post/markup.hpp"
#include "post/pictures/report_script.hpp"

#include <fmt/format.h>
#include <vtksys/Base64.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace dielast::post {

namespace {

// Free of < and &, so that the page is well-formed XML too.
constexpr std::string_view css = R"(
:root { --ink: #1d242c; --soft: #5b6672; --line: #e2e7ec; --panel: #f6f8fa; --accent: #2563a8;
        --good: #1a7f4b; --warning: #a86200; --bad: #c2283d; --paper: #fff; }
@media screen and (prefers-color-scheme: dark) {
  :root { --ink: #e3e8ee; --soft: #9fabb8; --line: #323a44; --panel: #20262d; --accent: #7db2ee;
          --good: #5cc78f; --warning: #e5a84b; --bad: #f0798a; --paper: #15191e; color-scheme: dark; }
  figure img { filter: brightness(0.9); }
}
* { box-sizing: border-box; }
body { margin: 0; color: var(--ink); background: var(--paper); font: 15px/1.55 system-ui, "Segoe UI", Roboto, Helvetica, Arial, "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 40px 28px 56px; }
header { border-bottom: 1px solid var(--line); padding-bottom: 18px; }
h1 { font-size: 28px; line-height: 1.25; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 19px; margin: 40px 0 12px; }
.subtitle { color: var(--soft); margin: 0; }
a { color: var(--accent); }
summary { cursor: pointer; color: var(--accent); }
.status { display: inline-block; margin-top: 12px; padding: 3px 12px; border-radius: 14px; font-weight: 600; font-size: 13.5px; background: var(--panel); border: 1px solid currentColor; }
.good { color: var(--good); } .warning { color: var(--warning); } .bad { color: var(--bad); }
td.good, td.warning, td.bad { font-weight: 600; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(155px, 1fr)); gap: 12px; margin: 24px 0 0; }
.card { background: var(--panel); border: 1px solid var(--line); border-radius: 8px; padding: 12px 14px; }
.card .label { color: var(--soft); font-size: 13px; }
.card .value { overflow-wrap: anywhere; font-size: 19px; font-weight: 600; font-variant-numeric: tabular-nums; }
.card .note { color: var(--soft); font-size: 12.5px; }
th.sorts { cursor: pointer; }
.csv { font-size: 12.5px; }
.scroll { overflow-x: auto; margin: 0 0 14px; }
table { border-collapse: collapse; min-width: 55%; font-size: 14px; font-variant-numeric: tabular-nums; }
th { text-align: left; color: var(--soft); font-weight: 600; font-size: 13px; border-bottom: 2px solid var(--line); }
th, td { padding: 6px 24px 6px 0; vertical-align: top; }
td { border-bottom: 1px solid var(--line); }
.number { text-align: right; }
pre { background: var(--panel); border: 1px solid var(--line); border-radius: 8px; padding: 12px 16px; overflow-x: auto; font: 12.5px/1.5 ui-monospace, "SF Mono", Consolas, "DejaVu Sans Mono", monospace; }
.images { display: grid; grid-template-columns: repeat(auto-fit, minmax(440px, 1fr)); gap: 20px; }
figure { margin: 0 0 12px; break-inside: avoid; }
figure { max-width: 620px; }
figure.wide, figure.slides { max-width: none; grid-column: 1 / -1; }
figure.slides { max-width: 760px; }
figure img { width: 100%; height: auto; border: 1px solid var(--line); border-radius: 8px; }
.drawing { position: relative; }
.mark { position: absolute; width: 11px; height: 11px; border: 2px solid #c2283d; border-radius: 50%; transform: translate(-50%, -50%); pointer-events: none; }
.reading { position: absolute; padding: 3px 9px; border-radius: 6px; background: #1d242c; color: #fff; font-size: 12.5px; white-space: pre; transform: translate(12px, 8px); pointer-events: none; z-index: 1; }
.reading.leftwards { transform: translate(calc(-100% - 12px), 8px); }
.controls { display: flex; gap: 12px; align-items: center; margin-top: 6px; }
.controls input { flex: 1; }
nav { margin: 18px 0 0; font-size: 13.5px; display: flex; flex-wrap: wrap; gap: 4px 16px; }
figcaption { color: var(--soft); font-size: 13px; margin-top: 4px; }
footer { margin-top: 44px; padding-top: 14px; border-top: 1px solid var(--line); color: var(--soft); font-size: 13px; }
@media print { nav, .controls, .csv { display: none; } main { max-width: none; padding: 0; } h2 { break-after: avoid; } tr { break-inside: avoid; }
  pre { white-space: pre-wrap; } .card, pre, .status { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
@media (max-width: 560px) { .images { grid-template-columns: 1fr; } }
)";

std::string_view css_class(Tone tone) {
  switch (tone) {
  case Tone::good:
    return "good";
  case Tone::warning:
    return "warning";
  case Tone::bad:
    return "bad";
  case Tone::plain:
    break;
  }
  return "";
}

bool starts_with_number(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) != 0;
}

/// A column is one of numbers when all its filled cells are; "-" stands for a missing one.
std::vector<bool> number_columns(const Table& table) {
  std::vector<bool> numeric(table.header.size());
  for (std::size_t column = 0; column < numeric.size(); ++column) {
    bool any = false, all = true;
    for (const auto& row : table.rows) {
      if (column >= row.size() || row[column].text.empty() || row[column].text == "-") continue;
      (starts_with_number(row[column].text) ? any : all) = starts_with_number(row[column].text);
    }
    numeric[column] = any && all;
  }
  return numeric;
}

std::string html_of(const Paragraph& paragraph) { return "<p>" + escape_markup(paragraph.text) + "</p>\n"; }

/// What is longer than a screen is folded.
std::string html_of(const Listing& listing) {
  constexpr std::ptrdiff_t most_lines = 25;
  const std::string text = "<pre>" + escape_markup(listing.text) + "</pre>";
  const auto lines = std::ranges::count(listing.text, '\n');
  if (lines <= most_lines) return text + "\n";
  return fmt::format("<details><summary>{} lines</summary>{}</details>\n", lines, text);
}

std::string linked(const std::string& text, const std::string& target) {
  if (target.empty()) return escape_markup(text);
  return fmt::format("<a href=\"{}\">{}</a>", escape_markup(target), escape_markup(text));
}

std::string html_of(const Table& table) {
  const std::vector<bool> numeric = number_columns(table);
  const auto is_number = [&](std::size_t column) { return column < numeric.size() && numeric[column]; };
  std::string html = "<div class=\"scroll\"><table>\n<thead><tr>";
  for (std::size_t c = 0; c < table.header.size(); ++c)
    html +=
        fmt::format("<th{}>{}</th>", is_number(c) ? " class=\"number\"" : "", escape_markup(table.header[c]));
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t c = 0; c < row.size(); ++c)
      html += fmt::format("<td class=\"{} {}\">{}</td>", is_number(c) ? "number" : "text",
                          css_class(row[c].tone), linked(row[c].text, row[c].link));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::size_t base64_size(const std::string& bytes) { return (bytes.size() + 2) / 3 * 4; }

/// Adds a drawing as a data URI: inline, the identifiers of several would clash.
void add_img(std::string& html, const std::string& svg, const std::string& words, bool hidden = false) {
  html += fmt::format("<img alt=\"{}\"{} src=\"data:image/svg+xml;base64,", escape_markup(words),
                      hidden ? " hidden=\"hidden\"" : "");
  const std::size_t begin = html.size();
  html.resize(begin + base64_size(svg));
  html.resize(begin + vtksysBase64_Encode(reinterpret_cast<const unsigned char*>(svg.data()), svg.size(),
                                          reinterpret_cast<unsigned char*>(&html[begin]), 0));
  html += "\"/>";
}

template<class AddDrawings>
void add_figure(std::string& html, const std::string& css_class, const std::string& readings,
                const std::string& caption, AddDrawings&& add_drawings) {
  html += fmt::format("<figure{}{}><div class=\"drawing\">",
                      css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class),
                      readings.empty() ? "" : fmt::format(" data-readings=\"{}\"", escape_markup(readings)));
  add_drawings();
  html += fmt::format("</div><figcaption>{}</figcaption></figure>\n", escape_markup(caption));
}

template<class Content>
void add(std::string& html, const Content& content) {
  html += html_of(content);
}

void add(std::string& html, const Image& image) {
  add_figure(html, image.wide ? "wide" : "", image.readings, image.caption,
             [&] { add_img(html, image.svg, image.caption); });
}

void add(std::string& html, const Slides& slides) {
  add_figure(html, "slides", slides.readings, slides.caption, [&] {
    for (const std::string& picture : slides.pictures)
      add_img(html, picture, slides.caption, &picture != &slides.pictures.back());
  });
}

bool could_be_drawn(const Block& block) {
  const auto* image = std::get_if<Image>(&block);
  const auto* slides = std::get_if<Slides>(&block);
  return !(image && image->svg.empty()) && !(slides && slides->pictures.empty());
}

void add(std::string& html, const Section& section, std::size_t number) {
  html += fmt::format("<section id=\"part{}\"><h2>{}</h2>\n", number, escape_markup(section.title));
  bool in_images = false;
  for (const Block& block : section.blocks) {
    if (!could_be_drawn(block)) continue;
    const bool is_image = std::holds_alternative<Image>(block) || std::holds_alternative<Slides>(block);
    if (is_image != in_images) html += in_images ? "</div>\n" : "<div class=\"images\">\n";
    in_images = is_image;
    std::visit([&](const auto& content) { add(html, content); }, block);
  }
  html += in_images ? "</div>\n</section>\n" : "</section>\n";
}

/// Characters that the drawings will take.
std::size_t size_of_drawings(const std::vector<Section>& sections) {
  std::size_t size = 0;
  for (const Section& section : sections)
    for (const Block& block : section.blocks) {
      if (const auto* image = std::get_if<Image>(&block)) size += base64_size(image->svg);
      if (const auto* slides = std::get_if<Slides>(&block))
        for (const std::string& picture : slides->pictures) size += base64_size(picture);
    }
  return size;
}

} // namespace

void Report::add(std::string section, std::vector<Image> images) {
  if (images.empty()) return;
  sections.push_back({std::move(section), {}});
  sections.back().add(std::move(images));
}

std::string Report::html() const {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<main>\n<header>{3}<h1>{0}</h1>"
      "<p class=\"subtitle\">{2}</p>",
      escape_markup(title), css, escape_markup(subtitle),
      part_of ? fmt::format("<p class=\"subtitle\">part of {}</p>", linked(part_of->text, part_of->target))
              : "");
  if (!status.text.empty())
    page += fmt::format("<span class=\"status {}\">{}</span>", css_class(status.tone),
                        escape_markup(status.text));
  page += "</header>\n";
  if (!highlights.empty()) page += "<div class=\"cards\">\n";
  for (const Highlight& highlight : highlights)
    page += fmt::format("<div class=\"card\"><div class=\"label\">{}</div><div class=\"value\">{}</div>"
                        "<div class=\"note\">{}</div></div>\n",
                        escape_markup(highlight.label), escape_markup(highlight.value),
                        escape_markup(highlight.note));
  if (!highlights.empty()) page += "</div>\n";
  constexpr std::size_t worth_a_list = 4;
  if (sections.size() >= worth_a_list) {
    page += "<nav>";
    for (std::size_t s = 0; s < sections.size(); ++s)
      page += fmt::format("<a href=\"#part{}\">{}</a>", s, escape_markup(sections[s].title));
    page += "</nav>\n";
  }
  constexpr std::size_t all_else = 100'000; // more or less
  page.reserve(size_of_drawings(sections) + all_else);
  for (std::size_t s = 0; s < sections.size(); ++s) post::add(page, sections[s], s);
  page += fmt::format("<footer>{}</footer>\n</main>\n<script>//<![CDATA[{}//]]></script>\n</body>\n</html>\n",
                      escape_markup(footer), report_script());
  return page;
}

std::vector<Figure> Report::figures() const {
  std::vector<Figure> figures;
  std::set<std::string> taken;
  for (const Section& section : sections)
    for (const Block& block : section.blocks)
      if (const auto* image = std::get_if<Image>(&block);
          image && !image->name.empty() && !image->svg.empty()) {
        std::string name;
        for (const char c : image->name)
          if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
          else if (!name.empty() && name.back() != '_')
            name += '_';
        if (name.ends_with('_')) name.pop_back();
        std::string own = name;
        for (int again = 2; !taken.insert(own).second; ++again) own = fmt::format("{}_{}", name, again);
        figures.push_back({fmt::format("figure_{}.svg", own), image->svg});
      }
  return figures;
}

} // namespace dielast::post
