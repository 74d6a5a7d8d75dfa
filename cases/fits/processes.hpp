// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace dielast::cases {

/// What a process has computed, or why it could not.
struct Computed {
  std::vector<double> values;
  std::string failure; ///< empty: there are values
};

/// work(0) ... work(count - 1), each in a process of its own, at most `parallel` at once: a run keeps a core
/// and libraries that know of no threads to itself. An exception of the work is its failure. Throws
/// std::system_error where no process can be made.
std::vector<Computed> in_processes(std::size_t count, int parallel,
                                   const std::function<std::vector<double>(std::size_t)>& work);

} // namespace dielast::cases
