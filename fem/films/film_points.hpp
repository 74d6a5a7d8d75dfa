// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/model/element_block.hpp"

namespace dielast::fem {

/// A block of film that tells of its points also where another one speaks for its cells in a model's samples
/// (MembraneSection::sampled): what an electrode leaves bare of a rod.
class FilmPoints : public ElementBlock {
 public:
  explicit FilmPoints(bool sampled) : sampled_(sampled) {}

  void sample(const State& state, Samples& samples) const final {
    if (sampled_) sample_points(state, samples);
  }
  virtual void sample_points(const State& state, Samples& samples) const = 0;

 private:
  bool sampled_;
};

} // namespace dielast::fem
