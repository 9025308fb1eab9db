// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Whole files by their names, in any alphabet.

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

/// The name of a file that a filter was given; `purpose` as in "to read".
/// @throws InvalidParameter if it was given none.
QString requiredName(const QString& name, const char* purpose);

/// A file to read from: the stream throws FileError where the system cannot read on.
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
 * Replaces a file by what `write` writes, or leaves it as it was: after an error such as a full disk, if `write`
 * throws, and if the process is killed.
 *
 * The new file is written beside the old one, flushed to the disk and renamed; a process that is killed may
 * leave it there, as `.mcfskel-NUMBER`. A symbolic link stays, and the file that it leads to is replaced. The
 * file's permissions and, where the user may, its owner are kept. Pipes, devices and what is open already, as
 * /dev/stdout, are written to, once `write` has written everything.
 *
 * Where the folder takes no new files the old one is overwritten, which needs memory for both: the space
 * is taken first and what the file held is put back after an error. Only there can a process that is killed
 * leave a mixture.
 * @throws FileError with the system's reason
 */
void writeFile(const QString& name, const std::function<void(std::ostream&)>& write);

} // namespace mcfskel

#endif
