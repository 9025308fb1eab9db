// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file The adapter for MeshLab and pymeshlab from 2021.05 on: the catalogue as a FilterPlugin.

#ifndef MCFSKEL_MESHLAB_2021_H
#define MCFSKEL_MESHLAB_2021_H

#include "../filters.h"

class FilterMcfskelPlugin : public QObject, public FilterPlugin
{
	Q_OBJECT
	MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
	Q_INTERFACES(FilterPlugin)

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
};

#endif
