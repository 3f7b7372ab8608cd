// SPDX-License-Identifier: BSD-3-Clause
#include "ipc/dds/library_log.hpp"

#include <dds/ddsrt/log.h>

namespace isobar::dds {
namespace {

using LibraryLogUse = void (*)(bool is_error, std::string_view line) noexcept;

void pass_on(void* use, const dds_log_data_t* data) {
  std::string_view line(data->message, data->size);
  while (!line.empty() && (line.back() == '\n' || line.back() == '\0')) line.remove_suffix(1);
  const bool is_error = (data->priority & (DDS_LC_FATAL | DDS_LC_ERROR)) != 0;
  const bool is_warning = (data->priority & DDS_LC_WARNING) != 0;
  if (is_error || is_warning) reinterpret_cast<LibraryLogUse>(use)(is_error, line);  // NOLINT: as given
}

}  // namespace

void set_library_log(LibraryLogUse use) {
  dds_set_log_sink(&pass_on, reinterpret_cast<void*>(use));  // NOLINT: the library hands it back
}

}  // namespace isobar::dds
