// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "fem/contact/face.hpp"

namespace dielast::fem {

/// A face on its straight way between two states: Bezier's control points, in whose hull it is, m.
struct MovingFace {
  FaceNodes from, to;
};

/// Of the face's nodes in two states.
MovingFace moving(const FaceNodes& from, const FaceNodes& to);

/// The part of a way, 0..`most`, on which two curved faces stay apart: as far as hulls of ever smaller parts
/// of theirs, over ever shorter parts of the way, are more than `clearance` (m, positive) apart; where that
/// is not told with `tests` of them the way ends. So no point of the one, whether on an edge or within,
/// passes through the other.
double way_apart(const MovingFace& one, const MovingFace& other, double clearance, double most,
                 int tests = 20'000);

/// Of the points of a face (see face_rule()) from another one, the least distance, m.
double gap_of_points(const FaceNodes& own, const FaceNodes& other);

/// The part of a way, at most `most`, on which the points of a face (see face_rule()) keep the part `kept` of
/// their gaps to another one: as far as these allow at the speed with which point and face move at most, or
/// as planes between point and face do (conservative advancement).
double way_of_points(const FaceNodes& own, const FaceNodes& own_to, const FaceNodes& other,
                     const FaceNodes& other_to, double kept, double most);

} // namespace dielast::fem
