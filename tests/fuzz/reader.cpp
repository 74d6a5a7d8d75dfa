// SPDX-License-Identifier: GPL-3.0-or-later
// Any text as a case, a study or a fit: it is refused with a message, or read and written back.
#include "cases/readers/reader.hpp"
#include "cases/readers/fit_reader.hpp"
#include "cases/readers/study_reader.hpp"
#include "tests/fuzz/round_trip.hpp"

using namespace dielast;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path file = [] {
    for (const char* beside : {"tests/cases/valid/drive.csv", "cases/gallery/material/cycle.csv",
                               "cases/gallery/fit/ecoflex_00-30_uniaxial.csv"})
      std::filesystem::copy(fuzz::source_folder / beside, fuzz::scratch());
    return fuzz::scratch() / "case.toml";
  }();
  const std::string_view text = fuzz::text_of(data, size);
  fuzz::write(file, text);
  try {
    if (text.find("[study") != std::string_view::npos)
      cases::read_study(file);
    else if (text.find("[fit") != std::string_view::npos)
      cases::fit_task(cases::read_fit(file));
    else
      fuzz::require_round_trip(cases::read_case(file));
  } catch (const cases::CaseError&) {
  } catch (const cases::FileError&) {
  } catch (const std::exception& error) {
    fuzz::fail(std::string("an error without a place: ") + error.what());
  }
  return 0;
}
