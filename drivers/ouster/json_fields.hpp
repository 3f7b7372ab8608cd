// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace isobar::ouster {

/// Fields of a metadata file. Firmware before 3.0 writes them side by side, later firmware in sections; a field
/// is looked for in its sections, then at the top.
class JsonFields {
 public:
  using Sections = std::initializer_list<const char*>;
  struct Range {
    double low;
    double high;
  };

  /// @throws ConfigError for text that is no JSON object
  JsonFields(std::string_view text, const std::string& file);

  [[nodiscard]] bool has(Sections sections, const char* key) const;
  /// @throws ConfigError, text "file: section.key: rule", when missing, of another type, or out of range
  [[nodiscard]] double number(Sections sections, const char* key, Range range) const;
  [[nodiscard]] int integer(Sections sections, const char* key, Range range) const;
  [[nodiscard]] std::vector<double> numbers(Sections sections, const char* key, Range range) const;
  [[nodiscard]] std::string text(Sections sections, const char* key) const;
  /// A number, or a text of digits; 0 where the field is missing or something else.
  [[nodiscard]] std::uint64_t identity(Sections sections, const char* key) const;

  [[noreturn]] void fail(Sections sections, const char* key, const std::string& rule) const;

 private:
  struct Found {
    const nlohmann::json* value;
    std::string name;  // section.key
  };
  [[nodiscard]] Found find(Sections sections, const char* key) const;
  [[nodiscard]] double checked(const nlohmann::json& value, const std::string& name, Range range) const;
  [[noreturn]] void fail(const std::string& name, const std::string& rule) const;

  std::string file_;
  nlohmann::json root_;
};

}  // namespace isobar::ouster
