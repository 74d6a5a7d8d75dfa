// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace dielast::post {

/// Rows of `width` pixels 0xAARRGGBB, colours multiplied by the opacity, as the bytes of a PNG file:
/// one per pixel of up to 256 colours. Neighbours are not subtracted first: that takes three times as long,
/// and colours that change by the steps of a palette come out larger. Throws std::runtime_error.
std::string png(std::span<const std::uint32_t> pixels, int width);

} // namespace dielast::post
