// SPDX-License-Identifier: BSD-3-Clause
// Folders of the black box: in memory for the ring, on the disk for what is saved.
#pragma once

#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "config/config.hpp"

namespace isobar::black_box {

/// Folder in memory that belongs to this user alone: blackbox/ in the service's runtime folder
/// ($RUNTIME_DIRECTORY), else /dev/shm/isobar-blackbox-UID.
/// @throws ServiceError when it cannot be made, or when /dev/shm holds one of that name of another user
[[nodiscard]] std::filesystem::path memory_folder();

/// Makes the ring's folder of this run below memory_folder().
/// @throws ServiceError when it cannot be made
[[nodiscard]] std::filesystem::path make_ring_folder(const std::filesystem::path& memory);

/// Rings of earlier runs that did not end cleanly, oldest first. Only one isobard runs on a machine, so that
/// every ring but the own one is a left-over.
[[nodiscard]] std::vector<std::filesystem::path> left_over_rings(const std::filesystem::path& memory);

/// Most memory for the ring: `max_mb`, but at most half of the free space of its file system, so that the next
/// start finds room for its shared memory beside a left-over.
[[nodiscard]] std::uint64_t ring_limit_bytes(const std::filesystem::path& memory, double max_mb);

/// Folder for saved recordings: black_box.directory, else blackbox/ in output.directory, else blackbox/ in
/// the service's state folder ($STATE_DIRECTORY); empty: none is known.
[[nodiscard]] std::filesystem::path save_folder(const Config& config);

/// Name of a saved recording, "20261128T202117Z-order": time in UTC, then the reason in letters, digits and
/// hyphens.
[[nodiscard]] std::string save_name(std::time_t utc_s, std::string_view reason);
/// True for a name that save_name() gives.
[[nodiscard]] bool is_save_name(std::string_view name);

/// Deletes the oldest saved recordings beyond the newest `keep`. Folders of other names are left alone.
/// @param newest is kept in any case: its name may be the oldest, as the clock of a robot may be wrong
void delete_old_saves(const std::filesystem::path& folder, int keep, const std::filesystem::path& newest);

}  // namespace isobar::black_box
