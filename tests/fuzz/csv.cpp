// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a wave's table and as a measured test: refused with a message, or read.
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/reader.hpp"
#include "tests/fuzz/target.hpp"

using namespace dielast;

namespace {

constexpr std::string_view wave = R"toml([film]
material = "VHB 4910"
thickness = "1 mm"
[patch]
[drive]
voltage = { wave = "file", file = "table.csv" }
[[step]]
kind = "transient"
duration = "1 s"
)toml";

constexpr std::string_view fit = R"toml([film.material]
law = "gent"
shear_modulus = "20 kPa"
stretch_limit = 100
[fit]
[[test]]
file = "table.csv"
kind = "uniaxial"
)toml";

template<class Read>
void expect_message(const Read& read) {
  try {
    read();
  } catch (const cases::CaseError&) {
  } catch (const std::exception& error) {
    fuzz::fail(std::string("an error without a place: ") + error.what());
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = [] {
    fuzz::write(fuzz::scratch() / "wave.toml", wave);
    fuzz::write(fuzz::scratch() / "fit.toml", fit);
    return fuzz::scratch();
  }();
  fuzz::write(folder / "table.csv", fuzz::text_of(data, size));
  expect_message([] {
    const cases::Case one = cases::read_case(folder / "wave.toml");
    const cases::Waveform& voltage = *one.drives.begin()->second.voltage;
    for (const double time : voltage.kinks(0, 1))
      if (!(voltage.at(time) == voltage.at(time))) fuzz::fail("a wave without a value");
  });
  expect_message([] { cases::fit_task(cases::read_fit(folder / "fit.toml")); });
  return 0;
}
