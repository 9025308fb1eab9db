// SPDX-FileCopyrightText: Mean Curvature Skeletons contributors
// SPDX-License-Identifier: GPL-3.0-or-later

/// @file
/// @brief Public: skeletons and stages in files.

#ifndef VCG_MCF_SKELETON_FILES_H
#define VCG_MCF_SKELETON_FILES_H

#include <skeleton/io/cg.h>
#include <skeleton/io/glb.h>
#include <skeleton/io/graphml.h>
#include <skeleton/io/json.h>
#include <skeleton/io/skeleton_file.h>
#include <skeleton/io/skeleton_ply.h>
#include <skeleton/io/stage_ply.h>
#include <skeleton/io/swc.h>
#include <skeleton/io/vtp.h>

#endif
