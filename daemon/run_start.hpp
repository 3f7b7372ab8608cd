// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/altitude/height_datum.hpp"
#include "core/registration/known_place.hpp"
#include "run/files/checkpoint.hpp"

namespace isobar {

/// Where a live run begins.
struct RunStart {
  std::uint32_t session = 1;        ///< number of the map frame
  std::optional<KnownPlace> place;  ///< of the run that is continued
  HeightDatum datum;                ///< of the run that is continued
  std::string other_station{};  ///< its heights are those of another base station: says of which; else empty
};

/// The start of a run that goes on where the checkpoint was written.
[[nodiscard]] RunStart continuation_of(const files::Checkpoint& checkpoint);

}  // namespace isobar
