// SPDX-License-Identifier: BSD-3-Clause
// Memory order of a chunk's hand-over, for ThreadSanitizer: the library orders it by atomics, but is not
// instrumented. In other builds these functions do nothing.
#pragma once

#include <iceoryx_posh/mepoo/chunk_header.hpp>

#if defined(__SANITIZE_THREAD__)
#define ISOBAR_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define ISOBAR_TSAN 1
#endif
#endif
#ifdef ISOBAR_TSAN
extern "C" void __tsan_acquire(void* address);  // NOLINT(bugprone-reserved-identifier)
extern "C" void __tsan_release(void* address);  // NOLINT(bugprone-reserved-identifier)
#endif

namespace isobar::ipc {

/// The library's header in front of a chunk's payload.
inline const iox::mepoo::ChunkHeader& header_of(const void* payload) {
  return *iox::mepoo::ChunkHeader::fromUserPayload(payload);
}

// Identified by the address of its header: the payload's address varies with the alignment of the topic that
// uses the chunk.
inline void mark_acquired([[maybe_unused]] const void* payload) noexcept {
#ifdef ISOBAR_TSAN
  __tsan_acquire(const_cast<iox::mepoo::ChunkHeader*>(&header_of(payload)));
#endif
}

inline void mark_released([[maybe_unused]] const void* payload) noexcept {
#ifdef ISOBAR_TSAN
  __tsan_release(const_cast<iox::mepoo::ChunkHeader*>(&header_of(payload)));
#endif
}

}  // namespace isobar::ipc
