// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Cancelling from scripts: pymeshlab cannot cancel a filter, so the caller provides a flag.

#ifndef MCFSKEL_CANCEL_FLAG_H
#define MCFSKEL_CANCEL_FLAG_H

namespace mcfskel {

/// The flag of the calling thread, see mcfskel_cancel_when(); null if it has none.
const volatile int* cancelFlag();

} // namespace mcfskel

/**
 * Filters that the calling thread starts after this call are cancelled as soon as `*flag` is not 0,
 * whichever thread sets it. For callers from other languages, through dlsym() or ctypes.
 * @param flag must outlive the filters; null: they are not cancelled.
 */
extern "C" void mcfskel_cancel_when(const volatile int* flag);

#endif
