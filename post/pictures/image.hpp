// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace dielast::post {

/// A picture or plot.
struct Image {
  std::string svg; ///< empty: it could not be drawn
  std::string caption{};
  bool wide = false;      ///< as wide as the page
  std::string name{};     ///< of the file beside the page, without its ending; empty: there is none
  std::string readings{}; ///< JSON: what the page says of the place under the pointer, see report_script()
};

/// Pictures of one size, one at a time: the last one until a slider moves.
struct Slides {
  std::vector<std::string> pictures; ///< SVG
  std::string caption{};
  std::string readings{}; ///< of each of them
};

} // namespace dielast::post
