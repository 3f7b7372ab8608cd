// SPDX-License-Identifier: BSD-3-Clause
#include "config/kept_config.hpp"

#include <charconv>
#include <string_view>
#include <system_error>

#include "config/config_io.hpp"
#include "config/config_layer.hpp"
#include "config/end_mark.hpp"
#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "run/files/text_file.hpp"
#include "run/text/small_file.hpp"

namespace isobar {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOf = "# Of: ";
constexpr std::string_view kSince = "# In force since (Unix time): ";

/// The rest of the first line that begins with `label`; empty: no such line.
std::string_view labelled(std::string_view text, std::string_view label) {
  const std::size_t at = text.find("\n" + std::string(label));
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at + 1 + label.size();
  return text.substr(begin, text.find('\n', begin) - begin);
}

std::int64_t number_in(std::string_view text) {
  std::int64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

}  // namespace

std::string config_identity(const fs::path& main) {
  std::error_code error;
  const fs::path absolute = fs::absolute(main, error);
  const fs::path folder = fs::weakly_canonical(absolute.parent_path(), error);
  constexpr std::size_t kMostLetters = 400;
  return printable(((error ? absolute.parent_path() : folder) / main.filename()).string(), kMostLetters);
}

void keep_config(const fs::path& file, const fs::path& main, const KeptConfig& kept) {
  std::string text(kEndMarkAnnouncement);
  text +=
      "\n# The last configuration that isobard has accepted. isobard writes it, and starts with it while the "
      "files\n# of the configuration are bad; a change here has no effect.\n";
  text += std::string(kOf) + config_identity(main) + "\n";
  text += std::string(kSince) + std::to_string(kept.since_s) + "\n";
  text += settings_in_force(kept.config);
  files::replace_file(file, with_checksum(text));
}

std::optional<KeptConfig> read_kept_config(const fs::path& file, const fs::path& main) {
  std::error_code error;
  if (fs::symlink_status(file, error).type() == fs::file_type::not_found) return std::nullopt;
  const std::string name = printable(file.string());
  const text::SmallFile read = text::read_small_file(file, text::kMostConfigBytes);
  if (!read.refusal.empty()) throw ConfigError(name + ": " + read.refusal);
  if (read.content.empty() || with_checksum(read.content) != read.content) {
    throw ConfigError(name + ": is damaged, or was not written by isobard: its checksum is missing or wrong");
  }
  if (const std::string_view of = labelled(read.content, kOf); of != config_identity(main)) {
    throw ConfigError(name + ": belongs to the configuration " + printable(of) + ", not to " +
                      config_identity(main));
  }
  return KeptConfig{parse_layers({{name, read.content}}).config, number_in(labelled(read.content, kSince))};
}

}  // namespace isobar
