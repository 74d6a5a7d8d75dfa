// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/png.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>
#include <stdexcept>

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

} // namespace

std::string png(std::span<const std::uint32_t> pixels, int width) {
  const auto columns = static_cast<std::size_t>(width), rows = pixels.size() / columns;
  const bool opaque = std::ranges::all_of(pixels, [](std::uint32_t pixel) { return pixel >> 24 == 0xff; });
  const std::size_t size = rows * (1 + (opaque ? 3 : 4) * columns);
  const auto lines = std::make_unique_for_overwrite<char[]>(size + 1); // the last pixel may write one more
  char* at = lines.get();
  for (std::size_t row = 0; row < rows; ++row) {
    *at++ = 0; // the line's filter: none
    for (const std::uint32_t pixel : pixels.subspan(row * columns, columns)) {
      const std::uint32_t opacity = pixel >> 24;
      std::uint32_t four = pixel << 8 | opacity; // red, green, blue, opacity from the highest byte on
      if (opacity % 0xff != 0)
        for (const int shift : {8, 16, 24}) {
          const std::uint32_t value = four >> shift & 0xff;
          four += ((0xff * value + opacity / 2) / opacity - value) << shift;
        }
      if constexpr (std::endian::native == std::endian::little) four = __builtin_bswap32(four);
      std::memcpy(at, &four, sizeof four);
      at += opaque ? 3 : 4;
    }
  }
  constexpr int fastest = 1;
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(fastest), libdeflate_free_compressor);
  if (!compressor) throw std::runtime_error("cannot write a picture: no memory");
  const std::size_t bound = libdeflate_zlib_compress_bound(compressor.get(), size);
  const auto packed = std::make_unique_for_overwrite<char[]>(bound);
  const std::size_t packed_size =
      libdeflate_zlib_compress(compressor.get(), lines.get(), size, packed.get(), bound);

  std::string header;
  append_number(header, columns);
  append_number(header, rows);
  constexpr char bits = 8, rgb = 2, rgba = 6, deflate = 0, filters = 0, not_interlaced = 0;
  header += {bits, opaque ? rgb : rgba, deflate, filters, not_interlaced};
  std::string bytes = "\x89PNG\r\n\x1a\n";
  append_chunk(bytes, "IHDR", header);
  append_chunk(bytes, "IDAT", {packed.get(), packed_size});
  append_chunk(bytes, "IEND", "");
  return bytes;
}

} // namespace dielast::post
