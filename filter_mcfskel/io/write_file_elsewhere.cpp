// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// For systems other than Linux, or where MCFSKEL_PORTABLE_FILES is defined: Qt alone, with the
// faults of QSaveFile that write_file.cpp names.

#include "files.h"

#include <QSaveFile>

#if !defined(Q_OS_LINUX) || defined(MCFSKEL_PORTABLE_FILES)

#include <sstream>
#include <string>

namespace mcfskel {

void writeFile(const QString& name, const std::function<void(std::ostream&)>& write)
{
	std::ostringstream content;
	content.exceptions(std::ios_base::badbit);
	write(content);
	const std::string bytes = content.str();
	QSaveFile file(name);
	const bool isWritten = file.open(QIODevice::WriteOnly)
		&& file.write(bytes.data(), qint64(bytes.size())) == qint64(bytes.size()) && file.commit();
	if (!isWritten)
		throw FileError(
			QString("Cannot write '%1': %2").arg(name, file.errorString()).toStdString());
}

} // namespace mcfskel

#endif
