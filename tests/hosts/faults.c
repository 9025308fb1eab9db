// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file A system that fails when it is told to. Preloaded into a process, it stands in front of the C library.

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stddef.h>
#include <unistd.h>

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* old, size_t size);
extern void* __libc_memalign(size_t alignment, size_t size);

static atomic_size_t counted = (size_t)-1; // requests below this size are never refused
static atomic_long seen, granted;
static atomic_int disk_error;

/// From now on requests of at least `size` bytes are counted, and refused after the first `count`.
void refuse_memory(long count, size_t size)
{
	seen = 0;
	granted = count;
	counted = size;
}

/// Refuses none any more. @return how many there were.
long grant_memory(void)
{
	counted = (size_t)-1;
	return seen;
}

/// The error of each fsync() from now on; 0: none.
void fail_disk(int error)
{
	disk_error = error;
}

static int refused(size_t size)
{
	if (size < counted || atomic_fetch_add(&seen, 1) < granted)
		return 0;
	errno = ENOMEM;
	return 1;
}

void* malloc(size_t size)
{
	return refused(size) ? NULL : __libc_malloc(size);
}

void* calloc(size_t count, size_t size)
{
	return refused(count * size) ? NULL : __libc_calloc(count, size);
}

void* realloc(void* old, size_t size)
{
	return refused(size) ? NULL : __libc_realloc(old, size);
}

void* memalign(size_t alignment, size_t size)
{
	return refused(size) ? NULL : __libc_memalign(alignment, size);
}

void* aligned_alloc(size_t alignment, size_t size)
{
	return memalign(alignment, size);
}

int posix_memalign(void** result, size_t alignment, size_t size)
{
	void* block = memalign(alignment, size);
	if (!block)
		return ENOMEM;
	*result = block;
	return 0;
}

int fsync(int file)
{
	static int (*next)(int);
	if (disk_error != 0) {
		errno = disk_error;
		return -1;
	}
	if (!next)
		next = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
	return next(file);
}
