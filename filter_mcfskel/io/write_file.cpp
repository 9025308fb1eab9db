// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Not QSaveFile: in Qt 5 its commit() ignores the error of its last flush and so replaces a good
// file by a truncated one on a full disk, its text for that error is "Unknown error", it replaces
// devices, and where it writes in place it truncates first.

#include "files.h"

#include <QFile>

#if defined(Q_OS_LINUX) && !defined(MCFSKEL_PORTABLE_FILES)

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <random>
#include <streambuf>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace mcfskel {

namespace {

namespace fs = std::filesystem;

/// Throws FileErrors about one file, by the name that the user gave it.
struct Errors
{
	QString name;

	[[noreturn]] void fail(int error) const
	{
		throw FileError(
			QString("Cannot write '%1': %2")
				.arg(name, QString::fromStdString(std::generic_category().message(error)))
				.toStdString());
	}

	/// @param failed whether the system call has.
	void check(bool failed) const
	{
		if (failed)
			fail(errno);
	}
};

/// Owns a file descriptor; negative: none.
class Descriptor
{
public:
	explicit Descriptor(int number) : number(number) {}

	~Descriptor()
	{
		if (number >= 0)
			::close(number);
	}

	Descriptor(const Descriptor&) = delete;
	Descriptor& operator=(const Descriptor&) = delete;

	operator int() const { return number; }

	/// Closes it; some file systems report a full disk only then.
	void close(const Errors& errors) { errors.check(::close(std::exchange(number, -1)) != 0); }

private:
	int number;
};

/// Blocks the signals that a failing write raises besides its error: they would end the host.
class HeldSignals
{
public:
	HeldSignals()
	{
		sigemptyset(&held);
		sigaddset(&held, SIGPIPE);
		sigaddset(&held, SIGXFSZ);
		sigpending(&before);
		pthread_sigmask(SIG_BLOCK, &held, &mask);
	}

	~HeldSignals()
	{
		const int error = errno;
		for (int signal : {SIGPIPE, SIGXFSZ})
			if (sigismember(&before, signal))
				sigdelset(&held, signal);
		const timespec now {0, 0};
		while (sigtimedwait(&held, nullptr, &now) > 0)
			;
		pthread_sigmask(SIG_SETMASK, &mask, nullptr);
		errno = error;
	}

	HeldSignals(const HeldSignals&) = delete;
	HeldSignals& operator=(const HeldSignals&) = delete;

private:
	sigset_t held, before, mask;
};

void writeAll(int file, const char* bytes, size_t count, const Errors& errors)
{
	const HeldSignals held;
	while (count > 0) {
		const ssize_t written = ::write(file, bytes, count);
		if (written < 0 && errno == EINTR)
			continue;
		errors.check(written < 0);
		bytes += written;
		count -= size_t(written);
	}
}

/// All that a file holds, from its beginning.
std::string readAll(int file, const Errors& errors)
{
	struct stat status;
	errors.check(::fstat(file, &status) != 0);
	std::string content(size_t(status.st_size), '\0');
	for (size_t done = 0; done < content.size();) {
		const ssize_t count = ::pread(file, &content[done], content.size() - done, off_t(done));
		if (count < 0 && errno == EINTR)
			continue;
		errors.check(count < 0);
		if (count == 0)
			content.resize(done); // truncated by another process
		done += size_t(count);
	}
	return content;
}

void flushToDisk(int file, const Errors& errors)
{
	// EINVAL: this kind of file cannot be flushed.
	errors.check(::fsync(file) != 0 && errno != EINVAL);
}

/// A stream buffer that passes blocks to `sink(bytes, count)`; the stream rethrows its exceptions.
template <class Sink>
class BlockBuffer : public std::streambuf
{
public:
	explicit BlockBuffer(const Sink& sink) : sink(sink), block(size_t(1) << 16) { clear(); }

protected:
	int_type overflow(int_type c) override
	{
		sync();
		if (!traits_type::eq_int_type(c, traits_type::eof()))
			sputc(traits_type::to_char_type(c));
		return traits_type::not_eof(c);
	}

	int sync() override
	{
		sink(pbase(), size_t(pptr() - pbase()));
		clear();
		return 0;
	}

private:
	void clear() { setp(block.data(), block.data() + block.size()); }

	Sink sink;
	std::vector<char> block;
};

template <class Sink>
void stream(const std::function<void(std::ostream&)>& write, const Sink& sink)
{
	BlockBuffer<Sink> buffer(sink);
	std::ostream out(&buffer);
	out.exceptions(std::ios_base::badbit); // rethrows what the buffer throws
	write(out);
	out.flush();
}

std::string inMemory(const std::function<void(std::ostream&)>& write)
{
	std::string content;
	stream(write, [&](const char* bytes, size_t count) { content.append(bytes, count); });
	return content;
}

/// Writes the complete content into a pipe or a device.
void writeThrough(Descriptor&& file, const std::string& content, const Errors& errors)
{
	errors.check(file < 0);
	writeAll(file, content.data(), content.size(), errors);
	file.close(errors);
}

/**
 * Overwrites the content of a file. The space is allocated first; after an error the old content is
 * restored. A process that is killed meanwhile leaves a mixture of both: this is the last resort.
 */
void writeInPlace(const fs::path& path, const std::string& content, const Errors& errors)
{
	Descriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
	errors.check(file < 0);
	const std::string old = readAll(file, errors);
	int error = 0;
	do {
		const HeldSignals held;
		error = content.empty() ? 0 : ::posix_fallocate(file, 0, off_t(content.size()));
	} while (error == EINTR);
	if (error != 0 && error != EINVAL && error != EOPNOTSUPP) {
		errors.check(::ftruncate(file, off_t(old.size())) != 0);
		errors.fail(error);
	}
	const auto write = [&](const std::string& bytes) {
		errors.check(::lseek(file, 0, SEEK_SET) != 0);
		writeAll(file, bytes.data(), bytes.size(), errors);
		errors.check(::ftruncate(file, off_t(bytes.size())) != 0);
		flushToDisk(file, errors);
	};
	try {
		write(content);
	}
	catch (const FileError& failed) {
		try {
			write(old);
		}
		catch (const FileError&) {
			throw FileError(
				std::string(failed.what()) + "; what it held could not be put back, and is lost");
		}
		throw;
	}
}

/// A new file beside another one, removed unless it took that one's place.
class NewFile
{
public:
	/// @param status of the existing file; null: there is none, the process's default mode is used.
	NewFile(const fs::path& beside, const struct stat* status) :
			file(create(beside.parent_path(), status ? status->st_mode & 0600 : 0666))
	{
		if (file < 0 || !status)
			return;
		// An owner or a group that the user may not set is not worth an error.
		if (::fchown(file, status->st_uid, status->st_gid) != 0)
			(void)!::fchown(file, uid_t(-1), status->st_gid);
		(void)!::fchmod(file, status->st_mode & 0777);
	}

	~NewFile()
	{
		if (file >= 0)
			::unlink(path.c_str());
	}

	NewFile(const NewFile&) = delete;
	NewFile& operator=(const NewFile&) = delete;

	int descriptor() const { return file; }

	/// @return whether it is now the file of that name; otherwise errno says why not.
	bool takePlaceOf(const fs::path& other) const
	{
		return ::rename(path.c_str(), other.c_str()) == 0;
	}

private:
	/// The name does not contain the other file's, which may be as long as a name can be.
	int create(const fs::path& folder, mode_t mode)
	{
		std::random_device random;
		int number = -1;
		for (int i = 0; i < 100 && number < 0; ++i) {
			path = folder / (".mcfskel-" + std::to_string(random()));
			number = ::open(path.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, mode);
			if (number < 0 && errno != EEXIST)
				break;
		}
		return number;
	}

	fs::path path;
	Descriptor file;
};

/// Whether a file that cannot be replaced may still be writable: so are files in a folder that
/// takes no new ones, and files that are mount points.
bool onlyInPlace(int error)
{
	return error == EACCES || error == EPERM || error == EROFS || error == EBUSY;
}

void replace(const fs::path& path, const struct stat* status,
	const std::function<void(std::ostream&)>& write, const Errors& errors)
{
	std::string content;
	{
		const NewFile file(path, status);
		if (file.descriptor() < 0 && !(status && onlyInPlace(errno)))
			errors.fail(errno);
		if (file.descriptor() < 0)
			content = inMemory(write);
		else {
			stream(write, [&](const char* bytes, size_t count) {
				writeAll(file.descriptor(), bytes, count, errors);
			});
			flushToDisk(file.descriptor(), errors);
			if (file.takePlaceOf(path)) {
				const Descriptor folder(
					::open(path.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
				::fsync(folder); // for the name: without it a crash may bring the old file back
				return;
			}
			if (!(status && onlyInPlace(errno)))
				errors.fail(errno);
			content = readAll(file.descriptor(), errors);
		}
	}
	writeInPlace(path, content, errors);
}

} // namespace

void writeFile(const QString& name, const std::function<void(std::ostream&)>& write)
{
	const Errors errors {name};
	const QByteArray encoded = QFile::encodeName(name);
	struct stat status;
	const bool exists = ::stat(encoded.constData(), &status) == 0;
	if (!exists && errno != ENOENT)
		errors.fail(errno);
	if (exists && S_ISDIR(status.st_mode))
		errors.fail(EISDIR);

	// A link stays, and what it leads to is written.
	std::error_code ignored;
	fs::path path = fs::absolute(encoded.toStdString(), ignored);
	while (fs::is_symlink(path, ignored)) {
		if (fs::equivalent(path.parent_path(), "/proc/self/fd", ignored))
			return writeThrough(
				Descriptor(::dup(std::atoi(path.filename().c_str()))), inMemory(write), errors);
		path = path.parent_path() / fs::read_symlink(path, ignored);
	}
	if (exists && !S_ISREG(status.st_mode)) {
		const std::string content = inMemory(write);
		return writeThrough(
			Descriptor(::open(path.c_str(), O_WRONLY | O_CLOEXEC)), content, errors);
	}
	// rename() would replace even a read-only file, against its owner's will.
	errors.check(exists && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0);
	replace(path, exists ? &status : nullptr, write, errors);
}

} // namespace mcfskel

#endif
