// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "config/config.hpp"
#include "daemon/service.hpp"

namespace isobar {

/// isobard in the role of a base station, until it is told to stop.
/// Throws ServiceError when the port cannot be bound or shared memory is refused.
void run_base_station(const Config& config, Service& service);

}  // namespace isobar
