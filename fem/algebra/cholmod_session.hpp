// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cholmod.h>

#include <vector>

namespace dielast::fem {

/// CHOLMOD's options and workspace; it prints nothing.
struct CholmodSession {
  CholmodSession() {
    cholmod_start(&common);
    common.error_handler = nullptr;
    common.print = 0;
  }
  ~CholmodSession() { cholmod_finish(&common); }
  CholmodSession(const CholmodSession&) = delete;
  CholmodSession& operator=(const CholmodSession&) = delete;

  cholmod_common common{};
};

/// A symmetric pattern as CHOLMOD reads it: compressed columns, rows ascending; what stands above the
/// diagonal is passed over. CHOLMOD changes neither of them, and they must outlive what is returned.
inline cholmod_sparse cholmod_pattern(const std::vector<int>& column_start, const std::vector<int>& rows) {
  cholmod_sparse pattern{};
  pattern.nrow = pattern.ncol = column_start.size() - 1;
  pattern.nzmax = rows.size();
  pattern.p = const_cast<int*>(column_start.data());
  pattern.i = const_cast<int*>(rows.data());
  pattern.stype = -1;
  pattern.itype = CHOLMOD_INT;
  pattern.xtype = CHOLMOD_PATTERN;
  pattern.dtype = CHOLMOD_DOUBLE;
  pattern.sorted = pattern.packed = 1;
  return pattern;
}

} // namespace dielast::fem
