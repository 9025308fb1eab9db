// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
#if MCFSKEL_FILES
/// @brief The plugin for MeshLab and pymeshlab since 2021.05: the catalogue as a FilterPlugin, the
/// file formats as an IOPlugin.
#else
/// @brief The plugin: the catalogue of filters as a FilterPlugin.
#endif

#ifndef MCFSKEL_MESHLAB_2021_H
#define MCFSKEL_MESHLAB_2021_H

#include "../filters.h"

class FilterMcfskelPlugin : public QObject,
							public FilterPlugin
#if MCFSKEL_FILES
		,
							public IOPlugin
#endif
{
	Q_OBJECT
	MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
#if MCFSKEL_FILES
	Q_INTERFACES(FilterPlugin IOPlugin)
#else
	Q_INTERFACES(FilterPlugin)
#endif

public:
	FilterMcfskelPlugin();

	QString pluginName() const override;
	QString vendor() const override;
	QString filterName(ActionIDType id) const override;
	QString pythonFilterName(ActionIDType id) const override;
	QString filterInfo(ActionIDType id) const override;
	FilterClass getClass(const QAction* action) const override;
	FilterArity filterArity(const QAction* action) const override;
	int getPreConditions(const QAction* action) const override;
	int postCondition(const QAction* action) const override;
	RichParameterList initParameterList(
		const QAction* action, const MeshDocument& document) override;
	std::map<std::string, QVariant> applyFilter(const QAction* action,
		const RichParameterList& parameters, MeshDocument& document,
		unsigned int& postConditionMask, vcg::CallBackPos* callback) override;

#if MCFSKEL_FILES
	std::list<FileFormat> importFormats() const override;
	std::list<FileFormat> exportFormats() const override;
	void exportMaskCapability(
		const QString& format, int& capability, int& defaultBits) const override;
	using IOPlugin::open;
	void open(const QString& format, const QString& file, MeshModel& layer, int& mask,
		const RichParameterList& parameters, vcg::CallBackPos* callback) override;
	void save(const QString& format, const QString& file, MeshModel& layer, const int mask,
		const RichParameterList& parameters, vcg::CallBackPos* callback) override;

private:
	/// Throws MLException after reading or writing has failed.
	[[noreturn]] void fail(const QString& error);
#endif
};

#endif
