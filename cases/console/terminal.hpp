// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cases/console/exit_code.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string>

namespace dielast::cases {

/// Prints to a standard stream. A stream that cannot be written to, as its reader has gone or its disk is
/// full, stops no command: finish_output() tells of it.
template<class... Values>
void say(std::FILE* stream, fmt::format_string<Values...> text, Values&&... values) {
  const std::string line = fmt::format(text, std::forward<Values>(values)...);
  std::fwrite(line.data(), 1, line.size(), stream);
}
template<class... Values>
void say(fmt::format_string<Values...> text, Values&&... values) {
  say(stdout, text, std::forward<Values>(values)...);
}

/// Prints a text, on a terminal that it does not fit on through the pager of the user ($PAGER, or less).
void show(const std::string& text);

/// Opens /dev/null where standard input, output or error is closed: the first file of results would take its
/// place, and what is printed would be written into it.
void open_standard_streams();

/// From here on nothing is printed to the standard output.
void close_standard_output();

/// The command's exit code: usage_or_file where it was ok but the standard output could not be written. A
/// pipe whose reader has gone is no error.
ExitCode finish_output(ExitCode code);

/// Makes SIGINT, SIGTERM and SIGHUP stop runs, studies and fits in good order; a second signal of any of them
/// ends the process at once. SIGPIPE and SIGXFSZ become errors of writing.
void catch_signals();
bool interrupted();

} // namespace dielast::cases
