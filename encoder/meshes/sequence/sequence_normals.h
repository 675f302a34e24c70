// Reads normals of later files of a sequence, which show how the normals of the first move.
#pragma once

#include "encoder/meshes/sequence/sequence_files.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// Reads normals of later frames into attributes.later_normals, with which the encoder compares
// the ways to code normals and their errors: all frames of a small sequence, otherwise frames
// at equal distances, the last included. Values of `normal` that move differently are split.
// Files that cannot be read are skipped: reading their positions reports the error. Takes as
// long as reading these files.
void add_later_normals(const SequenceFiles& files, SourceAttributes& attributes);

}  // namespace rlpc
