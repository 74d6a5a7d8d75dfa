// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/readers/reader.hpp"
#include "tests/cases/scratch.hpp"
#include "tests/cases/values_at_end.hpp"

namespace dielast::test {

/// A test of cases that it writes itself.
class CaseTest : public ScratchTest {
 protected:
  cases::Case read(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    write("case.toml", text);
    return cases::read_case(directory / "case.toml", overrides);
  }
  /// Values of the quantities at the end of a run that ends well.
  std::map<std::string, double> values(const std::string& text,
                                       const std::vector<std::string>& overrides = {}) const {
    return values_at_end(read(text, overrides));
  }
};

} // namespace dielast::test
