// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace dielast::test {

/// Whether a sanitizer watches: it must be loaded before anything else, moves memory, and needs terabytes of
/// addresses.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#elif defined(__has_feature)
inline constexpr bool sanitized = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool sanitized = false;
#endif

} // namespace dielast::test
