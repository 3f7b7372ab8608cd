// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "run/recording/manifest.hpp"
#include "run/recording/recording_reader.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/import/import_source.hpp"

namespace isobar::test {

/// A source as a recording: what import_source() says, and what it has written.
struct Imported {
  tools::ImportReport report;
  recording::Manifest manifest;
  std::vector<recording::Event> events;

  /// All notes, one a line.
  [[nodiscard]] std::string notes() const {
    std::string text;
    for (const std::string& note : report.notes) text += note + "\n";
    return text;
  }
  /// What a topic becomes; "missing" without a row.
  [[nodiscard]] std::string becomes(const std::string& topic) const {
    for (const tools::ImportRow& row : report.rows) {
      if (row.name == topic) return row.becomes;
    }
    return "missing";
  }
  [[nodiscard]] std::vector<recording::Event> of(recording::EventKind kind) const {
    std::vector<recording::Event> found;
    for (const auto& event : events) {
      if (event.kind == kind) found.push_back(event);
    }
    return found;
  }
};

/// Imports request.source into a temporary folder and reads all of it.
inline Imported import_and_read(tools::ImportRequest request) {
  const TemporaryFolder folder;
  request.out = folder.path() / "recording";
  Imported imported{.report = tools::import_source(request, [](double) {}), .manifest = {}, .events = {}};
  recording::RecordingReader reader(request.out);
  imported.manifest = reader.manifest();
  recording::Event event;
  while (reader.next(event)) imported.events.push_back(event);
  return imported;
}

}  // namespace isobar::test
