// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "cancel_flag.h"

#include <QtGlobal>

namespace {

thread_local const volatile int* flagOfThread = nullptr;

} // namespace

const volatile int* mcfskel::cancelFlag()
{
	return flagOfThread;
}

extern "C" Q_DECL_EXPORT void mcfskel_cancel_when(const volatile int* flag)
{
	flagOfThread = flag;
}
