// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Cancelling for scripts: pymeshlab has no way to end a filter, so its caller gives one.

#ifndef MCFSKEL_CANCEL_FLAG_H
#define MCFSKEL_CANCEL_FLAG_H

namespace mcfskel {

/// The flag of the calling thread, see mcfskel_cancel_when(); null if it has none.
const volatile int* cancelFlag();

} // namespace mcfskel

/**
 * The filters that the calling thread runs from now on are cancelled as soon as `*flag` is not 0, whoever
 * sets it. For callers from other languages, through dlsym() or ctypes; the flag must outlive the filters.
 * @param flag null: they are not cancelled any more.
 */
extern "C" void mcfskel_cancel_when(const volatile int* flag);

#endif
