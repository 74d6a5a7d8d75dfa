// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/materials/oracles.hpp"

namespace dielast::materials::test {

Eigen::MatrixXd condensed(const Eigen::MatrixXd& form, int kept, int flowing) {
  const Eigen::MatrixXd mixed = form.block(kept, 0, flowing, kept);
  return form.topLeftCorner(kept, kept) -
         mixed.transpose() * form.block(kept, kept, flowing, flowing).fullPivLu().solve(mixed);
}

} // namespace dielast::materials::test
