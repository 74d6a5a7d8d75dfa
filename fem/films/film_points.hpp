// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/samples.hpp"
#include "fem/model/state.hpp"

namespace dielast::fem {

/// A block of film that tells of its points also where another one speaks for its cells in a model's samples
/// (MembraneSection::sampled): the covers of a stack, what an electrode leaves bare of a rod.
class FilmPoints {
 public:
  virtual ~FilmPoints() = default;
  virtual void sample_points(const State& state, Samples& samples) const = 0;
};

} // namespace dielast::fem
