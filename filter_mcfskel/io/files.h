// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Reading files, and replacing them as a whole; names in any alphabet.

#ifndef MCFSKEL_FILES_H
#define MCFSKEL_FILES_H

#include <skeleton/support.h>

#include <QString>

#include <functional>
#include <iosfwd>
#include <memory>

namespace mcfskel {

/// A file cannot be read or written; the text names it and the system's reason.
class FileError : public vcg::tri::mcf::Error
{
public:
	using Error::Error;
};

/// Returns the file name that a filter was given; `purpose` completes the error, as in "to read".
/// @throws InvalidParameter if the name is empty.
QString requiredName(const QString& name, const char* purpose);

/// A file to read from. The stream throws FileError where the system cannot read on.
class InputFile
{
public:
	/// @throws FileError
	explicit InputFile(const QString& name);
	~InputFile();

	std::istream& stream();

private:
	struct Opened;
	std::unique_ptr<Opened> opened;
};

/**
 * Replaces a file by what `write` writes. The old file is unchanged after an error such as a full
 * disk, if `write` throws, and if the process is killed.
 *
 * The new file is written beside the old one, flushed to the disk and renamed; a process that is
 * killed may leave it behind as `.mcfskel-NUMBER`. A symbolic link stays, and the file that it
 * leads to is replaced. The file's permissions and, where the user may, its owner are kept. Pipes,
 * devices and what is open already, such as /dev/stdout, are written to once `write` has written
 * everything.
 *
 * Where the folder takes no new files the old one is overwritten, which needs memory for both
 * contents: the space is allocated first, and the old content is restored after an error. Only
 * there can a process that is killed leave a mixture. All this holds on Linux; for other systems
 * see write_file_elsewhere.cpp.
 * @throws FileError with the system's reason
 */
void writeFile(const QString& name, const std::function<void(std::ostream&)>& write);

} // namespace mcfskel

#endif
