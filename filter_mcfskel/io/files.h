// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file Whole files by their names, in any alphabet.

#ifndef MCFSKEL_FILES_H
#define MCFSKEL_FILES_H

#include <skeleton/errors.h>

#include <QString>

#include <string>

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

/// @throws FileError
std::string readFile(const QString& name);

/// Replaces a file, or leaves it as it was. @throws FileError
void writeFile(const QString& name, const std::string& content);

} // namespace mcfskel

#endif
