// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

namespace dielast::post {

namespace {

void append_number(std::string& bytes, std::size_t number) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift & 0xff);
}

/// Length, name, data and checksum of name and data.
void append_chunk(std::string& bytes, std::string_view name, std::string_view data) {
  append_number(bytes, data.size());
  const std::size_t begin = bytes.size();
  bytes.append(name).append(data);
  append_number(bytes, libdeflate_crc32(0, bytes.data() + begin, bytes.size() - begin));
}

/// Red, green, blue and opacity, from the highest byte on, the colours no longer multiplied by the opacity.
std::uint32_t rgba_of(std::uint32_t pixel) {
  const std::uint32_t opacity = pixel >> 24;
  std::uint32_t four = pixel << 8 | opacity;
  if (opacity % 0xff != 0)
    for (const int shift : {8, 16, 24}) {
      const std::uint32_t value = four >> shift & 0xff;
      four += ((0xff * value + opacity / 2) / opacity - value) << shift;
    }
  return four;
}

/// Up to 256 colours and their numbers.
class Colours {
 public:
  static constexpr std::size_t most = 256;
  /// In the order in which they were met.
  const std::vector<std::uint32_t>& all() const { return all_; }
  /// `most` where there are more.
  std::size_t number_of(std::uint32_t pixel) {
    for (std::size_t at = pixel * 0x9e3779b1u >> (32 - bits);; at = (at + 1) % places_.size()) {
      const Place& place = places_[at];
      if (place.used && place.colour == pixel) return place.number;
      if (place.used) continue;
      if (all_.size() == most) return most;
      places_[at] = {pixel, static_cast<std::uint16_t>(all_.size()), true};
      all_.push_back(pixel);
      return all_.size() - 1;
    }
  }

 private:
  struct Place {
    std::uint32_t colour = 0;
    std::uint16_t number = 0;
    bool used = false;
  };
  static constexpr int bits = 10;
  std::array<Place, 1 << bits> places_{};
  std::vector<std::uint32_t> all_;
};

/// Lines of a PNG file, each behind a byte for its filter: none.
struct Lines {
  std::unique_ptr<char[]> bytes;
  std::size_t size = 0;
};

/// A byte per pixel; nothing where there are more colours than that.
Lines numbered(std::span<const std::uint32_t> pixels, std::size_t columns, Colours& colours) {
  const std::size_t rows = pixels.size() / columns;
  Lines lines{std::make_unique_for_overwrite<char[]>(rows * (1 + columns)), rows * (1 + columns)};
  char* at = lines.bytes.get();
  std::uint32_t last = pixels.front();
  std::size_t number = colours.number_of(last);
  for (std::size_t row = 0; row < rows; ++row) {
    *at++ = 0;
    for (const std::uint32_t pixel : pixels.subspan(row * columns, columns)) {
      if (pixel != last) {
        last = pixel;
        number = colours.number_of(pixel);
        if (number == Colours::most) return {};
      }
      *at++ = static_cast<char>(number);
    }
  }
  return lines;
}

/// Three or four bytes per pixel.
Lines coloured(std::span<const std::uint32_t> pixels, std::size_t columns, bool opaque) {
  const std::size_t rows = pixels.size() / columns, size = rows * (1 + (opaque ? 3 : 4) * columns);
  Lines lines{std::make_unique_for_overwrite<char[]>(size + 1), size}; // the last pixel may write one more
  char* at = lines.bytes.get();
  for (std::size_t row = 0; row < rows; ++row) {
    *at++ = 0;
    for (const std::uint32_t pixel : pixels.subspan(row * columns, columns)) {
      std::uint32_t four = rgba_of(pixel);
      if constexpr (std::endian::native == std::endian::little) four = __builtin_bswap32(four);
      std::memcpy(at, &four, sizeof four);
      at += opaque ? 3 : 4;
    }
  }
  return lines;
}

} // namespace

std::string png(std::span<const std::uint32_t> pixels, int width) {
  const auto columns = static_cast<std::size_t>(width), rows = pixels.size() / columns;
  const bool opaque = std::ranges::all_of(pixels, [](std::uint32_t pixel) { return pixel >> 24 == 0xff; });
  Colours colours;
  Lines lines = numbered(pixels, columns, colours);
  const bool is_numbered = lines.bytes != nullptr;
  if (!is_numbered) lines = coloured(pixels, columns, opaque);
  constexpr int fastest = 1;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(fastest), libdeflate_free_compressor);
  if (!compressor) throw std::runtime_error("cannot write a picture: no memory");
  const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), lines.size);
  const auto packed = std::make_unique_for_overwrite<char[]>(bound);
  const std::size_t packed_size =
      libdeflate_zlib_compress(compressor.get(), lines.bytes.get(), lines.size, packed.get(), bound);

  std::string header;
  append_number(header, columns);
  append_number(header, rows);
  constexpr char bits = 8, rgb = 2, palette = 3, rgba = 6, deflate = 0, filters = 0, not_interlaced = 0;
  header += {bits, is_numbered ? palette : opaque ? rgb : rgba, deflate, filters, not_interlaced};
  std::string bytes = "\x89PNG\r\n\x1a\n";
  append_chunk(bytes, "IHDR", header);
  if (is_numbered) {
    std::string shades, opacities;
    for (const std::uint32_t colour : colours.all()) {
      const std::uint32_t four = rgba_of(colour);
      for (const int shift : {24, 16, 8}) shades += static_cast<char>(four >> shift & 0xff);
      opacities += static_cast<char>(four & 0xff);
    }
    append_chunk(bytes, "PLTE", shades);
    if (!opaque) append_chunk(bytes, "tRNS", opacities);
  }
  append_chunk(bytes, "IDAT", {packed.get(), packed_size});
  append_chunk(bytes, "IEND", "");
  return bytes;
}

} // namespace dielast::post
