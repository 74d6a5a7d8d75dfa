// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace dielast::meshing {

/// No usable mesh can be made or read; the message says what to change.
struct MeshError : std::runtime_error {
  explicit MeshError(const std::string& message, std::string of_region = "")
      : std::runtime_error(message), region(std::move(of_region)) {}

  std::string region; ///< name of the one to change; "": no region's fault
};

} // namespace dielast::meshing
