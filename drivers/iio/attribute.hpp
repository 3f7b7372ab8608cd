// SPDX-License-Identifier: BSD-3-Clause
// Attributes of a device in sysfs: small text files.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace isobar::iio {

/// Text of an attribute, without line end.
struct Attribute {
  int error = 0;  ///< 0 or errno
  std::array<char, 64> text{};
  std::size_t length = 0;
  [[nodiscard]] std::string_view view() const noexcept { return {text.data(), length}; }
};

/// @param name relative to the folder, "scan_elements/in_accel_x_type"
[[nodiscard]] Attribute read_attribute(const std::string& folder, std::string_view name) noexcept;
/// @return 0 or errno
int write_attribute(const std::string& folder, std::string_view name, std::string_view text) noexcept;
/// @return 0 or errno; EBADMSG: no number
int read_number(const std::string& folder, std::string_view name, double& value) noexcept;

/// Calls `visit(name)` for each file of a folder. Allocates nothing, unlike opendir().
/// @return 0 or errno
int for_each_file(const std::string& folder, void (*visit)(void* context, std::string_view name),
                  void* context) noexcept;

}  // namespace isobar::iio
