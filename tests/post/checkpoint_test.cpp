// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/checkpoint.hpp"

#include "tests/post/scratch.hpp"

#include <array>
#include <bit>
#include <limits>
#include <random>

namespace dielast::post::checkpoint_test {
namespace {

using nlohmann::json;

constexpr std::size_t nodes = 5, equations = 12;
constexpr StateSizes sizes{nodes, equations, equations - 3, 3, 2, 2, 3};

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

fem::RampProgress sample_progress(int points = 3) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&](std::size_t size) {
    return Eigen::VectorXd::NullaryExpr(static_cast<Eigen::Index>(size), [&] { return uniform(random); })
        .eval();
  };
  fem::RampProgress progress{.start = {{uniform(random), 1e3},
                                       {uniform(random), 0},
                                       {0, uniform(random)},
                                       vector(equations),
                                       vector(3)},
                             .load_factor = 1.0 / 3,
                             .increment = 0.1,
                             .unstable_modes = 2};
  for (int p = 0; p < points; ++p) {
    fem::State state;
    for (std::size_t n = 0; n < nodes; ++n) {
      state.displacement.emplace_back(uniform(random), -0.0, std::numeric_limits<double>::denorm_min());
      state.rotation.emplace_back(uniform(random), uniform(random), uniform(random), uniform(random));
      state.angle.emplace_back(uniform(random), uniform(random), 40 * uniform(random));
    }
    state.voltage = {uniform(random), 7500};
    state.supply = {fem::Supply::voltage, fem::Supply::charge};
    state.charge = {0, uniform(random)};
    state.time = uniform(random);
    state.scheme = materials::TimeScheme::bdf2(0.3, uniform(random));
    state.history = std::make_shared<const fem::History>(
        fem::History{{uniform(random), 1}, {uniform(random), 2}, {}, uniform(random), 0});
    state.dead_force = vector(equations);
    state.source = {uniform(random), 0};
    state.sheet_drop = vector(3);
    if (p > 0)
      state.motion = std::make_shared<const fem::Motion>(fem::Motion{vector(equations), vector(equations),
                                                                     vector(equations), vector(equations),
                                                                     vector(equations), uniform(random)});
    progress.points.push_back({uniform(random), state});
  }
  return progress;
}

fem::EnergyPoint sample_energy_point() {
  const auto pair = [](std::size_t size) {
    const auto n = static_cast<Eigen::Index>(size);
    return fem::Conjugates{Eigen::VectorXd::LinSpaced(n, 1.0 / 3, 2), Eigen::VectorXd::Random(n)};
  };
  return {.length = 0.1,
          .time = 0.2,
          .moves = true,
          .mechanical = pair(equations + sizes.ports),
          .electrical = pair(sizes.ports),
          .resistance = pair(sizes.ports),
          .sheet = pair(sizes.sheet_points),
          .power = {1.0 / 3, 2, 3, 4, 5}};
}

void expect_same(const fem::RampProgress& one, const fem::RampProgress& other) {
  EXPECT_EQ(one.start.voltage, other.start.voltage);
  EXPECT_EQ(one.start.dead_force, other.start.dead_force);
  EXPECT_EQ(one.start.charge, other.start.charge);
  EXPECT_EQ(one.start.source, other.start.source);
  EXPECT_EQ(one.start.held, other.start.held);
  EXPECT_EQ(bits(one.load_factor), bits(other.load_factor));
  EXPECT_EQ(bits(one.increment), bits(other.increment));
  EXPECT_EQ(one.unstable_modes, other.unstable_modes);
  ASSERT_EQ(one.points.size(), other.points.size());
  for (std::size_t p = 0; p < one.points.size(); ++p) {
    const fem::State &a = one.points[p].state, &b = other.points[p].state;
    EXPECT_EQ(bits(one.points[p].parameter), bits(other.points[p].parameter));
    EXPECT_EQ(a.voltage, b.voltage);
    EXPECT_EQ(a.supply, b.supply);
    EXPECT_EQ(a.charge, b.charge);
    EXPECT_EQ(bits(a.time), bits(b.time));
    EXPECT_EQ(bits(a.scheme.h2), bits(b.scheme.h2));
    ASSERT_EQ(a.history != nullptr, b.history != nullptr);
    if (a.history) {
      EXPECT_EQ(a.history->now, b.history->now);
      EXPECT_EQ(a.history->before, b.history->before);
      EXPECT_EQ(bits(a.history->step), bits(b.history->step));
    }
    EXPECT_EQ(a.source, b.source);
    EXPECT_EQ(a.sheet_drop, b.sheet_drop);
    ASSERT_EQ(a.motion != nullptr, b.motion != nullptr);
    if (a.motion) {
      EXPECT_EQ(a.motion->position, b.motion->position);
      EXPECT_EQ(a.motion->velocity, b.motion->velocity);
      EXPECT_EQ(a.motion->acceleration, b.motion->acceleration);
      EXPECT_EQ(a.motion->unbalanced, b.motion->unbalanced);
      EXPECT_EQ(a.motion->acceleration_now, b.motion->acceleration_now);
      EXPECT_EQ(bits(a.motion->step), bits(b.motion->step));
    }
    EXPECT_EQ(a.dead_force, b.dead_force);
    ASSERT_EQ(a.displacement.size(), b.displacement.size());
    for (std::size_t n = 0; n < nodes; ++n) {
      for (int c = 0; c < 3; ++c) EXPECT_EQ(bits(a.displacement[n][c]), bits(b.displacement[n][c]));
      for (int c = 0; c < 3; ++c) EXPECT_EQ(bits(a.angle[n][c]), bits(b.angle[n][c]));
      for (int c = 0; c < 4; ++c) EXPECT_EQ(bits(a.rotation[n].coeffs()[c]), bits(b.rotation[n].coeffs()[c]));
    }
  }
}

json through_file(const json& archived) { return json::from_cbor(json::to_cbor(archived)); }

TEST(Checkpoint, RestoresEveryBit) {
  for (const int points : {1, 4}) {
    const fem::RampProgress progress = sample_progress(points);
    expect_same(restore_ramp(through_file(archive(progress)), sizes), progress);
  }
}

TEST(Checkpoint, PacksWhatNumbersAsTextWouldLose) {
  const std::vector<double> odd{0.1,
                                -0.0,
                                5e-324,
                                1e308,
                                std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()};
  const std::vector<double> back = unpack(through_file(pack(odd)));
  ASSERT_EQ(back.size(), odd.size());
  for (std::size_t i = 0; i < odd.size(); ++i) EXPECT_EQ(bits(back[i]), bits(odd[i]));
  EXPECT_TRUE(unpack(through_file(pack({}))).empty());
}

TEST(Checkpoint, OnlyPacksAreUnpacked) {
  for (const json& other : {json(1.5), json("text"), json::array({1.0}), json(), json::binary({1, 2, 3})})
    EXPECT_THROW(unpack(other), std::runtime_error) << other;
}

TEST(Checkpoint, OfAnotherModelIsRefused) {
  const json archived = archive(sample_progress());
  EXPECT_NO_THROW(restore_ramp(archived, sizes));
  for (const auto member : {&StateSizes::nodes, &StateSizes::equations, &StateSizes::held, &StateSizes::ports,
                            &StateSizes::internal_variables, &StateSizes::sheet_points}) {
    StateSizes other = sizes;
    ++(other.*member);
    EXPECT_THROW(restore_ramp(archived, other), CheckpointError);
    other.*member = 0;
    EXPECT_THROW(restore_ramp(archived, other), CheckpointError);
  }
}

// Each of these was read beyond its end.
TEST(Checkpoint, VectorsOfAnotherLengthAreRefused) {
  const json archived = archive(sample_progress());
  for (const char* part : {"voltage", "charge", "source", "sheet_drop", "dead_force", "scheme"}) {
    json other = archived;
    other["points"][1]["state"][part] = pack(std::array{1.0});
    EXPECT_THROW(restore_ramp(other, sizes), CheckpointError) << part;
  }
  json other = archived;
  other["points"][1]["state"]["supply"] = {0};
  EXPECT_THROW(restore_ramp(other, sizes), CheckpointError);
  other["points"][1]["state"]["supply"] = {0, 7};
  EXPECT_THROW(restore_ramp(other, sizes), CheckpointError);
  other = archived;
  other["points"][1]["state"]["history"]["before"] = pack({});
  other["points"][1]["state"]["history"]["steps"][0] = 0.1;
  EXPECT_THROW(restore_ramp(other, sizes), CheckpointError);
}

TEST(Checkpoint, EnergiesAreKeptToTheLastBit) {
  const fem::EnergyPoint point = sample_energy_point();
  const fem::EnergyBalance::Record record{.work = {1.0 / 3, 2, 3, 4, 5, -1.0 / 7},
                                          .stored_at_start = 0.1,
                                          .exchanged = 0.2,
                                          .cut = 0.15,
                                          .without_cuts = 0.05,
                                          .doubt = 0.3,
                                          .rest = -0.4,
                                          .poor = {{0.5, 0.6}, {0.55, 0.9, true, 0.7, 3, 1}},
                                          .points = {point, point},
                                          .before_jump = Eigen::VectorXd{{0.8, -0.9}}};
  const json archived = archive(record);
  const fem::EnergyBalance::Record restored = restore_energy(archived, sizes);
  EXPECT_EQ(archive(restored), archived);
  EXPECT_EQ(restored.work.leak, record.work.leak);
  EXPECT_EQ(restored.cut, record.cut);
  EXPECT_EQ(restored.without_cuts, record.without_cuts);
  EXPECT_EQ(restored.rest, record.rest);
  ASSERT_EQ(restored.poor.size(), 2u);
  EXPECT_EQ(restored.poor[1].exchanged, 0.9);
  EXPECT_TRUE(restored.poor[1].given);
  EXPECT_EQ(restored.poor[1].row, 3);
  EXPECT_EQ(restored.poor[1].step, 1);
  EXPECT_EQ(restored.before_jump, record.before_jump);
  ASSERT_EQ(restored.points.size(), 2u);
  EXPECT_EQ(restored.points[1].power, point.power);
  EXPECT_EQ(restored.points[1].sheet.coordinate, point.sheet.coordinate);
}

TEST(Checkpoint, EnergiesOfAnotherLengthAreRefused) {
  const json archived = archive(
      fem::EnergyBalance::Record{.points = {sample_energy_point()}, .before_jump = Eigen::VectorXd::Zero(2)});
  EXPECT_NO_THROW(restore_energy(archived, sizes));
  for (const char* part : {"energy", "place", "power"}) {
    json other = archived;
    other["points"][0][part] = pack(std::array{1.0});
    EXPECT_THROW(restore_energy(other, sizes), CheckpointError) << part;
  }
  for (const char* part : {"mechanical", "electrical", "resistance", "sheet"})
    for (const int of : {0, 1}) {
      json other = archived;
      other["points"][0][part][of] = pack(std::array{1.0});
      EXPECT_THROW(restore_energy(other, sizes), CheckpointError) << part;
    }
  json none = archived;
  none["points"] = json::array();
  EXPECT_THROW(restore_energy(none, sizes), CheckpointError);
}

TEST(Checkpoint, DamageIsRefused) {
  const json archived = archive(sample_progress());
  for (const auto& [key, value] : archived.items()) {
    json without = archived, other = archived;
    without.erase(key);
    EXPECT_THROW(restore_ramp(without, sizes), std::runtime_error) << key;
    other[key] = "text";
    EXPECT_THROW(restore_ramp(other, sizes), std::runtime_error) << key;
  }
  json empty = archived;
  empty["points"] = json::array();
  EXPECT_THROW(restore_ramp(empty, sizes), std::runtime_error);
  EXPECT_THROW(restore_ramp(json(), sizes), std::runtime_error);
}

class CheckpointFile : public ScratchTest {
 protected:
  CheckpointFile() : content({{"numbers", pack(std::array{0.1, 5e-324})}, {"word", "voltage"}}) {}
  std::filesystem::path path() const { return directory / "checkpoint.cbor"; }
  void write(const std::string& bytes) const { std::ofstream(path(), std::ios::binary) << bytes; }

  json content;
};

TEST_F(CheckpointFile, ReadsBackAsItWasWritten) {
  write_checkpoint(path(), content);
  EXPECT_EQ(read_checkpoint(path()), content);
}

TEST_F(CheckpointFile, AnyChangedBitIsRefused) {
  write_checkpoint(path(), content);
  const std::string whole = ScratchTest::content("checkpoint.cbor");
  for (std::size_t byte = 0; byte < whole.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::string damaged = whole;
      damaged[byte] = static_cast<char>(damaged[byte] ^ (1 << bit));
      write(damaged);
      EXPECT_THROW(read_checkpoint(path()), CheckpointError) << byte << "." << bit;
    }
}

TEST_F(CheckpointFile, ShorterLongerOlderAndMissingOnesAreRefused) {
  write_checkpoint(path(), content);
  const std::string whole = ScratchTest::content("checkpoint.cbor");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write(whole.substr(0, size));
    EXPECT_THROW(read_checkpoint(path()), CheckpointError) << size;
  }
  const std::vector<std::uint8_t> older = json::to_cbor(content); // of 0.1.0, without a head
  for (const std::string& other : {whole + '\0', std::string(older.begin(), older.end())}) {
    write(other);
    EXPECT_THROW(read_checkpoint(path()), CheckpointError);
  }
  std::filesystem::remove(path());
  EXPECT_THROW(read_checkpoint(path()), CheckpointError);
}

} // namespace
} // namespace dielast::post::checkpoint_test
