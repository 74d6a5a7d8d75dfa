// SPDX-License-Identifier: GPL-3.0-or-later
// Any lines as what follows --set: refused with a message, or a case that is written back.
#include "cases/readers/reader.hpp"
#include "tests/fuzz/round_trip.hpp"

#include <sstream>

using namespace dielast;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::vector<std::filesystem::path> files = [] {
    std::vector<std::filesystem::path> all;
    for (const char* name :
         {"material/creep.toml", "diaphragm/step.toml", "honeycomb/case.toml", "circular/case.toml"})
      all.push_back(fuzz::source_folder / "cases/gallery" / name);
    return all;
  }();
  if (size == 0) return 0;
  std::istringstream lines(std::string(fuzz::text_of(data + 1, size - 1)));
  std::vector<std::string> overrides;
  for (std::string line; std::getline(lines, line);) overrides.push_back(line);
  try {
    fuzz::require_round_trip(cases::read_case(files[data[0] % files.size()], overrides));
  } catch (const cases::CaseError&) {
  } catch (const std::exception& error) {
    fuzz::fail(std::string("an error without a place: ") + error.what());
  }
  return 0;
}
