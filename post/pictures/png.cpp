// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/png.hpp"

#include <png.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace dielast::post {

std::string png(std::span<const std::uint32_t> pixels, int width) {
  const auto channel = [](std::uint32_t pixel, int shift) {
    return static_cast<unsigned char>(pixel >> shift & 0xff);
  };
  const bool opaque = std::ranges::all_of(pixels, [](std::uint32_t pixel) { return pixel >> 24 == 0xff; });
  std::vector<unsigned char> channels;
  channels.reserve((opaque ? 3 : 4) * pixels.size());
  for (const std::uint32_t pixel : pixels) {
    for (const int shift : {16, 8, 0}) channels.push_back(channel(pixel, shift));
    if (!opaque) channels.push_back(channel(pixel, 24));
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(pixels.size()) / image.width;
  image.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  image.flags = PNG_IMAGE_FLAG_FAST;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&image, bytes.data(), &size, 0, channels.data(), 0, nullptr))
    throw std::runtime_error(std::string("cannot write a picture: ") + image.message);
  bytes.resize(size);
  return bytes;
}

} // namespace dielast::post
