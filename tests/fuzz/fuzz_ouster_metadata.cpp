// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: the metadata of an Ouster. What is accepted makes a decoder.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/errors.hpp"
#include "drivers/ouster/decoder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const isobar::ouster::Decoder decoder("OS1", isobar::ouster::parse_metadata(text, "os.json", "OS1"));
    if (decoder.longest_packet() > 65'507) std::abort();
  } catch (const isobar::ConfigError&) {  // refused: the expected answer to nearly every input
  }
  return 0;
}
