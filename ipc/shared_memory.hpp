// SPDX-License-Identifier: BSD-3-Clause
// Zero-copy messages between threads and processes of one machine, through shared memory. The transport is
// iceoryx, named only by the sources in ipc/iceoryx/.
//
// One process, isobard, holds the Broker; every other process holds an Attachment. Publishers, Subscribers
// and Waiters exist only within the lifetime of the Broker or the Attachment of their process.
#pragma once

#include "ipc/broker.hpp"
#include "ipc/channel.hpp"
#include "ipc/waiter.hpp"
