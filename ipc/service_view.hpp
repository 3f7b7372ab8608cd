// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace isobar::ipc {

/// Folders that the units isobard.service and isobar-dds.service have as /dev/shm and /tmp, and their user.
struct ServiceFolders {
  std::string shared_memory = "/run/isobar/shm";
  std::string sockets = "/run/isobar/tmp";
  std::string user = "isobar";
};

/// Gives this process the services' /dev/shm and /tmp, which no other process of the machine sees: without them
/// a tool cannot attach to the isobard of the unit. Call it before Attachment, with one thread. As root, the
/// process becomes the services' user; it then writes no files for its caller. Does nothing inside the
/// services, where the services have not run since boot, and where an isobard that was started by hand runs.
/// @throws ServiceError with the remedy when this user may not attach
void enter_service_view(const ServiceFolders& service = {});

}  // namespace isobar::ipc
