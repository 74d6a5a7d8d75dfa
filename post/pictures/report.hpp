// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "post/pictures/image.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace dielast::post {

/// How a word or row is meant; shown by colour and never by colour alone.
enum class Tone { plain, good, warning, bad };

/// A page beside this one.
struct Link {
  std::string text;
  std::string target; ///< relative path
};

/// A cell of a table; cells that start with a number are aligned to the right.
struct Cell {
  Cell(std::string words, Tone meant = Tone::plain) : text(std::move(words)), tone(meant) {}
  Cell(const char* words, Tone meant = Tone::plain) : text(words), tone(meant) {}

  std::string text;
  Tone tone;
  std::string link{}; ///< the page that the text leads to, a relative path; empty: none
};

struct Paragraph {
  std::string text;
};
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<Cell>> rows;
};
/// Text whose line breaks and blanks count, such as an iteration log.
struct Listing {
  std::string text;
};
using Block = std::variant<Paragraph, Table, Listing, Image, Slides>;

/// A number worth seeing first.
struct Highlight {
  std::string label; ///< "eps_y"
  std::string value; ///< "33.19 %"
  std::string note;  ///< "± 0.05 %"; may be empty
};

/// Images of consecutive blocks stand side by side where the page is wide enough.
struct Section {
  std::string title;
  std::vector<Block> blocks;

  void add(std::vector<Image> images) {
    for (Image& image : images) blocks.emplace_back(std::move(image));
  }
};

/// A file beside a page.
struct Figure {
  std::string name; ///< "figure_max_field.svg"
  std::string svg;
};

/// A page about a run or a study: one HTML file that needs no other and no network. All texts are plain UTF-8
/// text.
struct Report {
  std::string title{}, subtitle{};
  std::optional<Link> part_of{}; ///< the page that this one belongs to
  Cell status{""};               ///< how it ended, e.g. {"converged", Tone::good}
  std::vector<Highlight> highlights{};
  std::vector<Section> sections{};
  std::string footer{}; ///< program, version

  /// Adds a section of images, where there are any.
  void add(std::string section, std::vector<Image> images);
  std::string html() const;
  /// Its images that have a name, as files for elsewhere: no two of one name.
  std::vector<Figure> figures() const;
};

} // namespace dielast::post
