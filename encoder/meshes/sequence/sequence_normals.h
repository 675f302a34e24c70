// Normals of later files of a sequence, which say how the normals of the first move.
#pragma once

#include "encoder/meshes/sequence/sequence_files.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// Reads normals of later frames into attributes.later_normals, with which the encoder compares
// the ways to code normals and their errors: those of all frames of a small sequence, otherwise
// of frames at equal distances, the last included. Values of `normal` that move differently
// become several. Nothing is added of files that cannot be read: reading them for their
// positions reports the error. Cost: that of reading these files.
void add_later_normals(const SequenceFiles& files, SourceAttributes& attributes);

}  // namespace rlpc
