// SPDX-License-Identifier: BSD-3-Clause
// A file mode mask of each thread's own, in every program that links this file: the function takes the place of
// libc's, also for shared libraries, because the program comes first in the order of symbols.
//
// iceoryx 2.0.3 sets the mask, which belongs to the whole process, makes a file and sets it back, in several threads.
// Two at once leave one's mask behind for good: folders of a run were then made with mode 0660, and nobody but root
// could write into them.
#include <sched.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

extern "C" mode_t umask(mode_t mask) noexcept {
  // Working folder and mask of this thread are from now on its own: unshare(2). Needs no privilege; where it is refused
  // the mask is the process's, as ever.
  static_cast<void>(::unshare(CLONE_FS));
  return static_cast<mode_t>(::syscall(SYS_umask, mask));
}
