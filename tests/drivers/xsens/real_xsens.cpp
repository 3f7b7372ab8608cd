// SPDX-License-Identifier: BSD-3-Clause
#include "tests/drivers/xsens/real_xsens.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace isobar::test {

namespace {

bool is_integer_item(const std::string& name) {
  return name == "PacketCounter" || name.starts_with("SampleTime") || name == "BaroPressure";
}

double value_of(const std::string& text) {
  const std::size_t colon = text.find(':');
  return std::strtod(text.c_str() + (colon == std::string::npos ? 0 : colon + 1), nullptr);
}

}  // namespace

XsensBytes load_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<XsensBytes> load_hex_lines(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<XsensBytes> lines;
  for (std::string line; std::getline(in, line);) {
    lines.emplace_back();
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      lines.back().push_back(static_cast<std::uint8_t>(std::stoi(line.substr(i, 2), nullptr, 16)));
    }
  }
  return lines;
}

std::vector<std::vector<XsensItem>> load_golden(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::vector<XsensItem>> messages(1);
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) {
      messages.emplace_back();
    } else if (line[0] != ' ') {
      messages.back().emplace_back(line.substr(0, line.find_last_of(':')), std::vector<double>{});
    } else {
      auto& [name, values] = messages.back().back();
      if (name.starts_with("Status")) {
        values.push_back(static_cast<double>(std::strtoull(line.c_str(), nullptr, 2)));
      } else if (name.ends_with(")") || is_integer_item(name)) {
        values.push_back(value_of(line));
      }
    }
  }
  if (messages.back().empty()) messages.pop_back();
  return messages;
}

std::vector<XsensExample> load_examples(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<XsensExample> examples;
  const std::regex number(R"(: *(-?\d+\.\d+|\d+)\b)");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("10 20 02 ")) {
      examples.emplace_back();
      std::istringstream words(line);
      for (std::string word; words >> word;) {
        examples.back().data.push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
      }
    } else if (line.starts_with("{(PacketCounter, 2 bytes") && !examples.empty()) {
      for (std::sregex_iterator at(line.begin(), line.end(), number), end; at != end; ++at) {
        examples.back().numbers.push_back(std::stod((*at)[1]));
      }
    }
  }
  return examples;
}

}  // namespace isobar::test
