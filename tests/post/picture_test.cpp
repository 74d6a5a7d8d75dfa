// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/pictures/picture.hpp"

#include "meshing/meridian.hpp"
#include "post/pictures/film_raster.hpp"
#include "post/pictures/legend.hpp"
#include "post/pictures/png.hpp"
#include "post/pictures/raster.hpp"
#include "tests/post/samples.hpp"

#include <Eigen/Geometry>
#include <cairo.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <vtksys/Base64.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

namespace dielast::post::picture_test {
namespace {

/// Whether no channel differs by more than rounding.
bool alike(std::uint32_t a, std::uint32_t b) {
  for (const int shift : {0, 8, 16})
    if (std::abs(static_cast<int>(a >> shift & 0xff) - static_cast<int>(b >> shift & 0xff)) > 1) return false;
  return true;
}

/// The pixels of a PNG file as 0xAARRGGBB.
struct Pixels {
  explicit Pixels(std::string bytes) {
    const auto read = [](void* rest, unsigned char* data, unsigned length) {
      auto& source = *static_cast<std::string*>(rest);
      if (source.size() < length) return CAIRO_STATUS_READ_ERROR;
      std::memcpy(data, source.data(), length);
      source.erase(0, length);
      return CAIRO_STATUS_SUCCESS;
    };
    cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read, &bytes);
    EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
    width = cairo_image_surface_get_width(surface);
    height = cairo_image_surface_get_height(surface);
    const int stride = cairo_image_surface_get_stride(surface) / 4;
    const auto* data = reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(surface));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) colours.push_back(data[y * stride + x] | 0xff000000u);
    cairo_surface_destroy(surface);
  }
  long count(std::uint32_t colour) const {
    return std::count_if(colours.begin(), colours.end(),
                         [&](std::uint32_t other) { return alike(colour, other); });
  }

  int width = 0, height = 0;
  std::vector<std::uint32_t> colours;
};

constexpr std::uint32_t lowest = 0xff440154, highest = 0xfffde725; // the ends of viridis

/// A square of n x n pairs of triangles, 0.1 m wide, without walls.
meshing::Mesh grid_mesh(int n) {
  meshing::Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.nodes.emplace_back(0.1 * i / n, 0.1 * j / n, 0);
  meshing::CellBlock block{meshing::CellType::triangle3, {}};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      block.nodes.insert(block.nodes.end(), {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1});
    }
  mesh.blocks = {block};
  return mesh;
}

// Slivers and triangles far outside, too.
TEST(Raster, DrawsThePixelsWhoseCentresLieInATriangle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-10, 50), exponent(-14, 2);
  for (int draw = 0; draw < 2000; ++draw) {
    const auto point = [&] { return Eigen::Vector2d(place(random), place(random)); };
    Eigen::Vector2d a = point(), b = point(), c = point();
    if (draw % 3 == 1)
      c.y() = (b.y() = a.y()) + std::pow(10, exponent(random)); // a side nearly along the rows
    if (draw % 3 == 2) b *= 1e4;
    Raster raster(40, 40);
    raster.draw({{{a, 0, 0}, {b, 0, 0}, {c, 0, 0}}}, Palette(Colour{1, 0, 0}));
    const auto px_left_of = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                               const Eigen::Vector2d& p) {
      const Eigen::Vector2d along = (to - from).normalized(), away = p - from;
      return along.x() * away.y() - along.y() * away.x();
    };
    const double turn = px_left_of(a, b, c) > 0 ? 1 : -1;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const Eigen::Vector2d p(x + 0.5, y + 0.5);
        const double inside =
            std::min({turn * px_left_of(a, b, p), turn * px_left_of(b, c, p), turn * px_left_of(c, a, p)});
        if (std::abs(inside) < 1e-3) continue; // on a side
        EXPECT_EQ(raster.pixels()[40 * y + x] != 0, inside > 0) << draw << ": " << x << ", " << y;
      }
  }
}

// Of four pixels half are covered by a red triangle: half of the colour, seen through by half.
TEST(Raster, HalvedHasMeansOfFourPixels) {
  Raster raster(4, 2, true);
  raster.draw({{{{0, 0}, 0, 0}, {{1, 0}, 0, 0}, {{0, 1e9}, 0, 0}}}, Palette(Colour{1, 0, 0}));
  Raster half = raster.halved();
  EXPECT_EQ(half.width(), 2);
  EXPECT_EQ(half.height(), 1);
  EXPECT_EQ(half.pixels()[0], 0x80800000u);
  EXPECT_EQ(half.pixels()[1], 0u);
}

// A byte for each pixel while there are 256 colours, otherwise one for each channel.
TEST(Png, DividesColoursByTheirOpacity) {
  for (const std::uint32_t others : {0u, 251u, 252u}) {
    std::vector<std::uint32_t> pixels{0x80800000u, 0u, 0xff123456u, 0x40004020u};
    for (std::uint32_t i = 0; i < 254; ++i) pixels.push_back(0xff000000u | 257 * std::min(i, others));
    const auto width = static_cast<int>(pixels.size()) / 2;
    std::string bytes = png(pixels, width);
    EXPECT_EQ(bytes.find("PLTE") != std::string::npos, others < 252) << others;
    const auto read = [](void* rest, unsigned char* data, unsigned length) {
      auto& source = *static_cast<std::string*>(rest);
      std::memcpy(data, source.data(), length);
      source.erase(0, length);
      return CAIRO_STATUS_SUCCESS;
    };
    cairo_surface_t* surface = cairo_image_surface_create_from_png_stream(read, &bytes);
    ASSERT_EQ(cairo_image_surface_get_width(surface), width); // which multiplies them again
    const unsigned char* data = cairo_image_surface_get_data(surface);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const std::size_t row = i / static_cast<std::size_t>(width),
                        column = i % static_cast<std::size_t>(width);
      std::uint32_t read_back = 0;
      std::memcpy(&read_back,
                  data + row * static_cast<std::size_t>(cairo_image_surface_get_stride(surface)) + 4 * column,
                  4);
      EXPECT_EQ(read_back, pixels[i]) << i;
    }
    cairo_surface_destroy(surface);
  }
}

/// All as wide.
std::vector<double> walls(const meshing::Mesh& mesh, double width) {
  return std::vector<double>(static_cast<std::size_t>(mesh.walls()->size()), width);
}

TEST(Picture, IsAPngOfTheWidthAskedFor) {
  const meshing::Mesh mesh = square_mesh();
  const std::string bytes =
      render_png(mesh, {.title = "Square",
                        .quantity = "Thickness",
                        .unit = "m",
                        .wall_widths = walls(mesh, 0.05),
                        .panels = {{"a", mesh.nodes, {1e-3, 2e-3}}, {"b", mesh.nodes, {1e-3, 2e-3}}},
                        .width = 900});
  EXPECT_TRUE(bytes.starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(Pixels(bytes).width, 900);
}

TEST(Picture, HasNoSeamsBetweenTriangles) {
  const meshing::Mesh mesh = grid_mesh(40);
  std::vector<Eigen::Vector3d> turned = mesh.nodes;
  for (auto& x : turned) x = {0.8 * x.x() - 0.6 * x.y(), 0.6 * x.x() + 0.8 * x.y(), 0};
  const Pixels pixels(render_png(mesh, {.panels = {{"", turned, {}}}, .width = 500}));
  const auto film = [](std::uint32_t colour) { return alike(colour, 0xffdbe3eb); };
  const auto row = pixels.colours.begin() + static_cast<std::ptrdiff_t>(250) * pixels.width;
  const auto first = std::find_if(row, row + pixels.width, film);
  auto last = row + pixels.width;
  while (last != first && !film(*(last - 1))) --last;
  EXPECT_GT(last - first, 200);
  EXPECT_TRUE(std::all_of(first, last, film));
}

TEST(Picture, ColoursSpanTheRangeOfAllPanels) {
  const meshing::Mesh mesh = grid_mesh(1);
  const Pixels pixels(render_png(mesh, {.quantity = "Field",
                                        .unit = "V/m",
                                        .panels = {{"", mesh.nodes, {0, 0}}, {"", mesh.nodes, {8e7, 8e7}}}}));
  // Each panel is half of the width and square; the colour bar adds a few pixels.
  EXPECT_NEAR(static_cast<double>(pixels.count(lowest)), 576 * 576, 0.03 * 576 * 576);
  EXPECT_NEAR(static_cast<double>(pixels.count(highest)), 576 * 576, 0.03 * 576 * 576);
}

TEST(Picture, NoTickIsMinusZero) {
  EXPECT_EQ(tick_label(-0.0, 0), "0");
  EXPECT_EQ(tick_label(-1e-12, 2), "0.00");
  EXPECT_EQ(tick_label(-0.5, 1), "-0.5");
}

TEST(Picture, PanelsShareOneScale) {
  const meshing::Mesh mesh = grid_mesh(1);
  std::vector<Eigen::Vector3d> half = mesh.nodes;
  for (auto& x : half) x *= 0.5;
  const Pixels pixels(render_png(
      mesh, {.quantity = "Field", .unit = "V/m", .panels = {{"", mesh.nodes, {0, 0}}, {"", half, {1, 1}}}}));
  EXPECT_NEAR(static_cast<double>(pixels.count(lowest)) / static_cast<double>(pixels.count(highest)), 4, 0.1);
}

TEST(Picture, WallsHaveTheirTrueWidth) {
  meshing::Mesh mesh = grid_mesh(1);
  mesh.blocks.push_back({meshing::CellType::line2, {0, 1}});
  const double width = 0.01;
  const Pixels pixels(
      render_png(mesh, {.wall_widths = walls(mesh, width), .panels = {{"", mesh.nodes, {}}}, .width = 600}));
  const double scale = (600 - 2 * 44) / (0.1 + width);
  const double area = scale * scale * (0.1 * width + M_PI / 4 * width * width); // round ends
  EXPECT_NEAR(static_cast<double>(pixels.count(0xff292e38)), area, 0.03 * area);
  mesh.blocks.back().nodes = {0, 1, 2, 3};
  const Pixels two(
      render_png(mesh, {.wall_widths = {width, width / 5}, .panels = {{"", mesh.nodes, {}}}, .width = 600}));
  EXPECT_NEAR(static_cast<double>(two.count(0xff292e38)), 1.2 * area, 0.07 * area);
}

TEST(Picture, ALineDoesNotBeginAtTheEndOfTheTextBeforeIt) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, 100, 20);
  cairo_t* cr = cairo_create(surface);
  draw_text(cr, "rods", 10, 10, 10, {});
  EXPECT_FALSE(cairo_has_current_point(cr));
  cairo_destroy(cr);
  cairo_surface_destroy(surface);
}

// A ridge of a thousandth of the width: its sides are lit from aside, differently. Flat film has its full
// colours.
TEST(Picture, LightShowsTheReliefOfNearlyFlatFilm) {
  const meshing::Mesh mesh = grid_mesh(2);
  std::vector<Eigen::Vector3d> ridge = mesh.nodes;
  for (auto& x : ridge)
    if (std::abs(x.x() - 0.05) < 1e-9) x.z() = 1e-4;
  constexpr std::uint32_t plain = 0xffdbe3eb;
  const auto sides = [&](const std::vector<Eigen::Vector3d>& positions) {
    const Pixels pixels(render_png(mesh, {.panels = {{"", positions, {}}}, .width = 600}));
    const auto at = [&](int x) { return pixels.colours[static_cast<std::size_t>(200 * pixels.width + x)]; };
    return std::pair{at(180), at(420)};
  };
  const auto [left, right] = sides(ridge);
  EXPECT_FALSE(alike(left, right));
  EXPECT_EQ(sides(mesh.nodes), (std::pair{plain, plain}));
}

TEST(Picture, MarksNodesWithTheirNames) {
  const meshing::Mesh mesh = grid_mesh(1);
  Picture picture{.panels = {{"", mesh.nodes, {}}}, .width = 600};
  constexpr std::uint32_t red = 0xffc2293d;
  EXPECT_EQ(Pixels(render_png(mesh, picture)).count(red), 0);
  picture.marks = {{"corner", {1}}, {"side", {0, 2, 3}}};
  const Pixels pixels(render_png(mesh, picture));
  EXPECT_GT(pixels.count(red), 50);
  // The second mark's dots lie over the first one's, at both ends of the diagonal.
  for (const auto& [x, y] : {std::pair{44, 44 + 512}, std::pair{44 + 512, 44}})
    EXPECT_TRUE(alike(pixels.colours[static_cast<std::size_t>(y * pixels.width + x)], 0xff2663a8)) << x;
  picture.marks = {{"nothing", {}}};
  EXPECT_THROW(render_png(mesh, picture), std::invalid_argument);
}

TEST(Picture, FinsAreDrawnToScale) {
  meshing::Mesh mesh = grid_mesh(2);
  const int first = mesh.node_count();
  for (const auto& [x, y] : {std::pair{-0.05, 0.0}, {-0.1, 0.0}, {-0.1, 0.1}, {-0.05, 0.1}})
    mesh.nodes.emplace_back(x, y, 0);
  const Pixels pixels(render_png(mesh, {.fins = {{first, first + 1, first + 2, first + 3}},
                                        .panels = {{"Text is drawn before it", mesh.nodes, {}}},
                                        .width = 600}));
  const double scale = (600 - 2 * 44) / 0.2, area = 0.05 * 0.1 * scale * scale;
  EXPECT_NEAR(static_cast<double>(pixels.count(0xffb8c2cc)), area, 0.03 * area);
}

TEST(Picture, SurvivesUniformAndMissingValues) {
  const meshing::Mesh mesh = grid_mesh(1);
  for (const double value : {0.0, 5.0, std::nan("")})
    EXPECT_FALSE(
        render_png(mesh, {.quantity = "x", .unit = "1", .panels = {{"", mesh.nodes, {value, value}}}})
            .empty());
}

TEST(Picture, ValuesAreSmoothWithinARegionAndJumpBetweenRegions) {
  const meshing::Mesh mesh = grid_mesh(1);
  const auto drawn = [&](std::vector<int> regions) {
    return Pixels(render_png(mesh, {.panels = {{"", mesh.nodes, {0, 1}, std::move(regions)}}, .width = 400}));
  };
  constexpr double half = 312 * 312 / 2.0;
  EXPECT_LT(static_cast<double>(drawn({}).count(lowest)), 0.05 * half);
  EXPECT_NEAR(static_cast<double>(drawn({0, 1}).count(lowest)), half, 0.03 * half);
  EXPECT_NEAR(static_cast<double>(drawn({0, 1}).count(highest)), half, 0.03 * half);
}

TEST(Picture, FilmWithoutAValueIsGrey) {
  const meshing::Mesh mesh = grid_mesh(1);
  const Pixels pixels(render_png(mesh, {.panels = {{"", mesh.nodes, {NAN, 1}}}, .width = 400}));
  EXPECT_NEAR(static_cast<double>(pixels.count(0xffbfbfbf)), 312 * 312 / 2.0, 0.03 * 312 * 312 / 2.0);
}

// A square on its edge is a line from above, and an area from aside.
TEST(Picture, WhatIsNotFlatIsSeenFromAside) {
  const meshing::Mesh mesh = grid_mesh(1);
  std::vector<Eigen::Vector3d> upright = mesh.nodes;
  for (auto& x : upright) x = {x.x(), 0, x.y()};
  const Pixels pixels(render_png(mesh, {.panels = {{"", upright, {1, 1}}}, .width = 400}));
  const auto film =
      std::ranges::count_if(pixels.colours, [](std::uint32_t c) { return !alike(c, 0xffffffff); });
  EXPECT_GT(film, 30000);
}

TEST(Raster, TheNearerHidesTheFarther) {
  for (const bool first : {true, false}) {
    Raster raster(10, 10);
    const auto draw = [&](double depth, double value) {
      raster.draw(
          {Corner{{0, 0}, depth, value}, Corner{{30, 0}, depth, value}, Corner{{0, 30}, depth, value}},
          Palette(std::pair(0.0, 1.0)));
    };
    draw(first ? 2 : 1, first ? 1 : 0);
    draw(first ? 1 : 2, first ? 0 : 1);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(raster.pixels()[i], highest);
  }
}

TEST(Raster, WhatIsTurnedFromTheLightIsDarker) {
  Raster raster(1, 1);
  raster.draw({Corner{{0, 0}, 0, 1}, Corner{{3, 0}, 0, 1}, Corner{{0, 3}, 0, 1}},
              Palette(std::pair(0.0, 1.0)), 0.5);
  EXPECT_TRUE(alike(raster.pixels()[0], 0xff7e7412)) << std::hex << raster.pixels()[0];
}

TEST(Picture, RefusesPanelsThatDoNotFit) {
  const meshing::Mesh mesh = grid_mesh(1);
  EXPECT_THROW(render_png(mesh, {}), std::invalid_argument);
  EXPECT_THROW(render_png(mesh, {.panels = {{"", {}, {}}}}), std::invalid_argument);
  EXPECT_THROW(render_png(mesh, {.panels = {{"", mesh.nodes, {1}}}}), std::invalid_argument);
  const meshing::Mesh balloon = meshing::balloon_meridian(1, 4, 2);
  EXPECT_THROW(render_png(balloon, {.panels = {{"", balloon.nodes, {}}}}), std::invalid_argument);
}

// A page tells values by colours: the ends of the readings' range are those of the colours.
TEST(Picture, ReadingsAreTheRangeOfTheColours) {
  const meshing::Mesh mesh = square_mesh();
  const Picture picture{
      .quantity = "Thickness", .unit = "m", .panels = {{"", mesh.nodes, {1e-3, 2e-3}, {0, 1}}}, .width = 400};
  const Image image = draw(mesh, picture, "shape");
  EXPECT_EQ(nlohmann::json::parse(image.readings),
            (nlohmann::json{{"range", {1.0, 2.0}}, {"quantity", "Thickness"}, {"unit", "mm"}}));
  EXPECT_NE(image.svg.find("<svg"), std::string::npos);
  EXPECT_NE(image.svg.find("<image"), std::string::npos); // the film
  EXPECT_EQ(draw(mesh, {.panels = {{"", mesh.nodes, {}}}}).readings, "");
}

/// The film of a drawing, a PNG file within it.
Pixels film_of(const std::string& svg) {
  const std::string before = "data:image/png;base64,";
  const std::size_t begin = svg.find(before) + before.size(), end = svg.find('"', begin);
  std::string bytes(end - begin, '\0');
  bytes.resize(vtksysBase64_Decode(reinterpret_cast<const unsigned char*>(&svg[begin]), bytes.size(),
                                   reinterpret_cast<unsigned char*>(bytes.data()), 0));
  return Pixels(bytes);
}

// A small state among slides stays small, and has the colours of the common range.
TEST(Picture, SlidesHaveOneScale) {
  const meshing::Mesh mesh = grid_mesh(2);
  std::vector<Eigen::Vector3d> half = mesh.nodes;
  for (Eigen::Vector3d& x : half) x /= 2;
  const auto slides = draw_slides(
      mesh, {.panels = {{"a", mesh.nodes, std::vector<double>(8, 1)}, {"b", half, std::vector<double>(8, 2)}},
             .width = 400});
  ASSERT_EQ(slides.pictures.size(), 2u);
  const Pixels large = film_of(slides.pictures[0]), small = film_of(slides.pictures[1]);
  EXPECT_EQ(large.width, 400 - 2 * 44);
  EXPECT_EQ(large.width, small.width);
  EXPECT_EQ(large.height, small.height);
  EXPECT_EQ(large.count(lowest), static_cast<long>(large.colours.size()));
  EXPECT_NEAR(static_cast<double>(large.count(lowest)) / static_cast<double>(small.count(highest)), 4, 0.1);
}

// Edges of film are drawn finer than pixels but where walls lie over all of them.
TEST(Picture, FilmInAFrameLooksAsIfItsEdgesWereSmooth) {
  meshing::Mesh mesh = square_mesh();
  for (Eigen::Vector3d& x : mesh.nodes) x = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * x;
  EXPECT_FALSE(is_framed(mesh));
  std::vector<int>& lines = mesh.blocks[0].nodes;
  lines.insert(lines.end(), {1, 2, 5, 2, 3, 6, 3, 4, 8, 4, 1, 9});
  EXPECT_TRUE(is_framed(mesh));
  const auto drawn = [&](const std::vector<int>& regions) {
    return Pixels(render_png(
        mesh,
        {.wall_widths = walls(mesh, 0.05), .panels = {{"", mesh.nodes, {1.0, 1.0}, regions}}, .width = 400}));
  };
  const Pixels framed = drawn({}), smooth = drawn({0, 1}); // as colours may jump between regions
  EXPECT_TRUE(std::ranges::equal(framed.colours, smooth.colours, alike));
}

} // namespace
} // namespace dielast::post::picture_test
