// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "meshlab_2020.h"

#include "scrolling_dialog.h"
#include "translate.h"

using namespace mcfskel;

FilterMcfskelPlugin::FilterMcfskelPlugin()
{
	for (int id = 0; id < int(catalogue().size()); ++id) {
		typeList.push_back(id);
		actionList.push_back(new QAction(filterName(id), this));
	}
}

QString FilterMcfskelPlugin::pluginName() const
{
	return "FilterMcfskel";
}

QString FilterMcfskelPlugin::filterName(FilterIDType id) const
{
	return host::filterOf(id).menuName;
}

QString FilterMcfskelPlugin::filterInfo(FilterIDType id) const
{
	return host::filterOf(id).help;
}

MeshFilterInterface::FilterClass FilterMcfskelPlugin::getClass(QAction* action)
{
	return host::filterClass(host::filterOf(ID(action)));
}

MeshFilterInterface::FILTER_ARITY FilterMcfskelPlugin::filterArity(QAction* action) const
{
	return host::filterOf(ID(action)).needsLayer ? SINGLE_MESH : NONE;
}

int FilterMcfskelPlugin::getPreConditions(QAction* action) const
{
	return host::filterOf(ID(action)).preConditions;
}

int FilterMcfskelPlugin::postCondition(QAction* action) const
{
	return host::filterOf(ID(action)).changes;
}

void FilterMcfskelPlugin::initParameterSet(
	QAction* action, MeshDocument& document, RichParameterList& list)
{
	host::addParameters(list, host::filterOf(ID(action)), document);
	if (host::hasWindow())
		host::scrollDialogWhereTooHigh(filterName(ID(action)));
}

bool FilterMcfskelPlugin::applyFilter(QAction* action, MeshDocument& document,
	const RichParameterList& parameters, vcg::CallBackPos* callback)
{
	const FilterSpec& filter = host::filterOf(ID(action));
	const auto values = [&] { return host::readParameters(parameters, filter, document); };
	const auto writeLog = [this](const QString& line) {
		MeshFilterInterface::Log(line.toStdString());
	};
	const Outcome outcome = runFilter(filter, document, values, writeLog, callback);
	if (outcome.error.isEmpty())
		return true;
	// meshlabserver does not print errorMessage, so the log gets the reason as well.
	MeshFilterInterface::errorMessage = outcome.error;
	writeLog(outcome.error);
	return false;
}

namespace {

QList<MeshIOInterface::Format> fileFormats(bool (SkeletonFormat::*possible)() const)
{
	QList<MeshIOInterface::Format> formats;
	for (const SkeletonFormat& format : skeletonFormats())
		if ((format.*possible)())
			formats << MeshIOInterface::Format(format.description, format.extension);
	return formats;
}

} // namespace

QList<MeshIOInterface::Format> FilterMcfskelPlugin::importFormats() const
{
	return fileFormats(&SkeletonFormat::isRead);
}

QList<MeshIOInterface::Format> FilterMcfskelPlugin::exportFormats() const
{
	return fileFormats(&SkeletonFormat::isWritten);
}

void FilterMcfskelPlugin::GetExportMaskCapability(QString&, int& capability, int& defaultBits) const
{
	capability = defaultBits = writtenElements;
}

bool FilterMcfskelPlugin::open(const QString&, const QString& file, MeshModel& layer, int& mask,
	const RichParameterList&, vcg::CallBackPos*, QWidget*)
{
	const FileOutcome outcome = openSkeleton(file, layer);
	mask = outcome.mask;
	return finished(outcome);
}

bool FilterMcfskelPlugin::save(const QString&, const QString& file, MeshModel& layer, const int,
	const RichParameterList&, vcg::CallBackPos*, QWidget*)
{
	return finished(saveSkeleton(file, layer));
}

bool FilterMcfskelPlugin::finished(const FileOutcome& outcome)
{
	// meshlabserver shows nothing of what its readers and writers log, nor their errors.
	for (const QString& warning : outcome.warnings) {
		MeshIOInterface::Log(GLLogStream::WARNING, warning.toStdString());
		qWarning("%s", qUtf8Printable(warning));
	}
	if (outcome.error.isEmpty())
		return true;
	MeshIOInterface::errorMessage = outcome.error;
	MeshIOInterface::Log(GLLogStream::SYSTEM, outcome.error.toStdString());
	qCritical("%s", qUtf8Printable(outcome.error));
	return false;
}
