// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "files.h"

#include <QFile>
#include <QSaveFile>

namespace mcfskel {

namespace {

FileError fileError(const char* what, const QString& name, const QFileDevice& file)
{
	return FileError(
		QString("Cannot %1 '%2': %3").arg(what, name, file.errorString()).toStdString());
}

} // namespace

QString requiredName(const QString& name, const char* purpose)
{
	if (name.isEmpty())
		throw vcg::tri::mcf::InvalidParameter(
			std::string("Parameter file must name the file ") + purpose + ".");
	return name;
}

std::string readFile(const QString& name)
{
	QFile file(name);
	if (!file.open(QIODevice::ReadOnly))
		throw fileError("read", name, file);
	const QByteArray content = file.readAll();
	if (file.error() != QFileDevice::NoError)
		throw fileError("read", name, file);
	return content.toStdString();
}

void writeFile(const QString& name, const std::string& content)
{
	QSaveFile file(name);
	// A device or a folder that takes no new files can still be written to.
	file.setDirectWriteFallback(true);
	if (!file.open(QIODevice::WriteOnly)
		|| file.write(content.data(), qint64(content.size())) != qint64(content.size())
		|| !file.commit())
		throw fileError("write", name, file);
}

} // namespace mcfskel
