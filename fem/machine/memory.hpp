// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace dielast::fem {

/// Memory that this process can have without taking it from others, bytes; infinity where the system does not
/// say it.
double available_memory();

/// Throws std::runtime_error, which says how much `what` takes and how much there is, where that is less:
/// Linux gives any memory away, and ends a process that uses what there is not.
void require_memory(double bytes, const std::string& what, double available = available_memory());

/// To be called before BLAS is: throws std::runtime_error where it gets no buffer. OpenBLAS would try for
/// ever to get one where memory is limited.
void require_blas_buffer();

/// To be called before anything else takes memory: workspaces that come and go with every factorisation keep
/// their pages, and the heap has large ones, where Linux gives these to those who ask. A page is a fault the
/// first time, which takes up to 10 us in a virtual machine.
void keep_pages();

} // namespace dielast::fem
