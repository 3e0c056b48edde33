/// Ctrl-C: a flag that the work looks at, so that files are closed properly.
#pragma once

namespace topple::app {

/// From now on the first Ctrl-C (or a request to terminate) only raises the flag; a second one ends the program at once.
void watch_for_interrupt();

bool interrupted();

}  // namespace topple::app
