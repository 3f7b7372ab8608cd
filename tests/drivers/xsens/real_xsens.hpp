// SPDX-License-Identifier: BSD-3-Clause
// Readers of the recordings xsens-xbus of other projects. The data are not part of this project.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace isobar::test {

using XsensBytes = std::vector<std::uint8_t>;

/// An item of a message as text: "Acceleration(Float32)" and its numbers, or its integer.
using XsensItem = std::pair<std::string, std::vector<double>>;

[[nodiscard]] XsensBytes load_bytes(const std::filesystem::path& file);
/// Lines of hexadecimal digits.
[[nodiscard]] std::vector<XsensBytes> load_hex_lines(const std::filesystem::path& file);
/// Messages of `output.golden`, items whose values are no list of numbers or an integer without values.
[[nodiscard]] std::vector<std::vector<XsensItem>> load_golden(const std::filesystem::path& file);
/// An example of mti-300_mtmanager_packets.md: data of an MTData2, and the numbers of its decoded text.
struct XsensExample {
  XsensBytes data;
  std::vector<double> numbers;
};
[[nodiscard]] std::vector<XsensExample> load_examples(const std::filesystem::path& file);

}  // namespace isobar::test
