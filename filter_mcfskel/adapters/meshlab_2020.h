// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief The adapter for MeshLab and meshlabserver up to 2020.12: the catalogue as a
/// MeshFilterInterface, the file formats as a MeshIOInterface.

#ifndef MCFSKEL_MESHLAB_2020_H
#define MCFSKEL_MESHLAB_2020_H

#include "../filters.h"
#include "../io/formats.h"

class FilterMcfskelPlugin : public QObject, public MeshFilterInterface, public MeshIOInterface
{
	Q_OBJECT
	Q_PLUGIN_METADATA(IID MESH_FILTER_INTERFACE_IID)
	Q_INTERFACES(MeshFilterInterface MeshIOInterface)

public:
	FilterMcfskelPlugin();

	QString pluginName() const override;
	QString filterName(FilterIDType id) const override;
	QString filterInfo(FilterIDType id) const override;
	FilterClass getClass(QAction* action) override;
	FILTER_ARITY filterArity(QAction* action) const override;
	int getPreConditions(QAction* action) const override;
	int postCondition(QAction* action) const override;
	void initParameterSet(
		QAction* action, MeshDocument& document, RichParameterList& list) override;
	bool applyFilter(QAction* action, MeshDocument& document, const RichParameterList& parameters,
		vcg::CallBackPos* callback) override;

	QList<Format> importFormats() const override;
	QList<Format> exportFormats() const override;
	void GetExportMaskCapability(QString& format, int& capability, int& defaultBits) const override;
	bool open(const QString& format, const QString& file, MeshModel& layer, int& mask,
		const RichParameterList& parameters, vcg::CallBackPos* callback, QWidget* parent) override;
	bool save(const QString& format, const QString& file, MeshModel& layer, const int mask,
		const RichParameterList& parameters, vcg::CallBackPos* callback, QWidget* parent) override;

private:
	bool finished(const mcfskel::FileOutcome& outcome);
};

#endif
