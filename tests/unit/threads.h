// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef MCFSKEL_TESTS_THREADS_H
#define MCFSKEL_TESTS_THREADS_H

#include <omp.h>

/// So many threads while it lives, where OpenMP decides.
class ThreadCount
{
public:
	explicit ThreadCount(int threads) : before(omp_get_max_threads())
	{
		omp_set_num_threads(threads);
	}
	~ThreadCount() { omp_set_num_threads(before); }
	ThreadCount(const ThreadCount&) = delete;
	ThreadCount& operator=(const ThreadCount&) = delete;

private:
	int before;
};

#endif
