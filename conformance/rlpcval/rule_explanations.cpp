#include "conformance/rlpcval/rule_explanations.h"

#include <algorithm>
#include <array>

namespace rlpc {
namespace {

constexpr std::array kRules = std::to_array<RuleExplanation>({
    {"R-AST-01", "7.16", "The asset is not one zlib stream that inflates to asset_size bytes.",
     "asset_size is the size before inflating; or bytes follow the zlib stream.",
     "Write the size of the asset itself, and one complete zlib stream without a dictionary."},
    {"R-AST-02", "7.16", "An asset of asset_format 0 is not a GLB.",
     "The JSON of a .gltf file was written, or a file that was cut off.",
     "Write a whole binary glTF 2.0 file, without meshes."},
    {"R-AST-03", "7.16", "An asset is not where it belongs, or there are two.",
     "It was written at the end, or before the connectivity.",
     "Write it after the connectivity unit and before the first GOF or rig unit."},
    {"R-ATT-01", "F.3", "The attribute unit is not between connectivity and the first GOF.",
     "A tool appended the unit to a stream, or copied it into one that had attributes.",
     "Write one attribute unit after the connectivity, before all GOFs and shared rigs."},
    {"R-ATT-02", "F.3", "There are too many attribute sets.",
     "Each part of the mesh was given sets of its own.",
     "Write at most 64 sets; one set of triangles can say which part each belongs to."},
    {"R-ATT-03", "F.3", "The domain of a set does not exist, or triangles have smoothing.",
     "Normals of triangles were written as smoothing; or reading is out of step.",
     "Use domains 0 to 2. Smoothing is for vertices and corners; flat shading is smoothing of "
     "corners with seams everywhere."},
    {"R-ATT-04", "F.3", "The bits, step or origin of a set are out of range.",
     "Unit vectors need 2 bits for each component at least; an origin was written in units of "
     "the values instead of steps.",
     "Use a step from 2^-126 to 2^127, and origins of up to 2^24 steps."},
    {"R-ATT-05", "F.3", "The prediction of a set does not exist for its values.",
     "Only unit vectors, and integers of two components, can be predicted from positions.",
     "Use prediction_idc 0 or 1."},
    {"R-ATT-06", "F.3", "The weight of faces or the kind of diagonals does not exist.",
     "Reading is out of step.", "Use 0 to 2 for both."},
    {"R-ATT-07", "F.3", "The difference of two floats has more than 32 bits.",
     "The difference was not taken modulo 2^32, or of other bits than those of OrderedBits( ).",
     "Code the difference of the ordered bits, modulo 2^32 if that is shorter."},
    {"R-ATT-08", "F.3",
     "The first frame is not the one that the attributes were predicted from.",
     "Slices or frames of the first GOF were left out, or the frames were encoded again, with "
     "the old attribute unit.",
     "Encode the attributes again from the first frame as it is decoded now, or remove their "
     "unit."},
    {"R-ATT-09", "F.3",
     "The name of an attribute set is not UTF-8 without control characters, or occurs twice.",
     "A name in another encoding, or with a terminating zero byte; two sets of one kind "
     "without numbers.",
     "Write names in UTF-8, without a zero at the end, and number sets of one kind: uv0, uv1."},
    {"R-BIT-01", "9.2",
     "A fixed-length or Exp-Golomb code goes past the end of its payload, or the stream ends "
     "within signature and version.",
     "The file was cut off, unit_size is too small, or an element before was written with "
     "another number of bits.",
     "Compare the elements before this one with the syntax table, one by one; unit_size counts "
     "the payload alone, without header and CRC."},
    {"R-BIT-02", "9.2", "byte_alignment( ) skips bits that are not zero.",
     "The bit writer flushes its last byte with old contents or fills it with ones.",
     "Fill with zero bits up to the next byte. If the bits look like data, an element before "
     "was written too short or twice."},
    {"R-BIT-03", "9.2", "The payload continues after the end of its syntax.",
     "Padding to a multiple of 4 or 8 bytes, an element that this version does not have, or a "
     "unit_size that counts the CRC.",
     "Write exactly the bytes of the syntax table; units need no padding."},
    {"R-BIT-04", "9.2", "An Exp-Golomb code begins with more than 32 zero bits.",
     "The value was negative, or above 2^33 - 2, before it was coded; or reading is out of "
     "step "
     "because an element before is wrong.",
     "Check the value for underflow (x_minus1 of 0) and the elements before it."},
    {"R-BON-01", "7.11", "The step of rest positions is above 65536.",
     "The step was computed in grid units, or for a grid far finer than the target needs; or "
     "reading is out of step.",
     "The step counts sixteenths of a grid unit. Use a coarser grid if it must be so "
     "large."},
    {"R-BON-02", "7.11", "There are more than 255 component groups.",
     "Each trajectory was put into a group of its own.",
     "Put several trajectories into one group; groups are what a stream can be cut to."},
    {"R-BON-03", "7.11", "A layer group has no layers.",
     "There are more layer groups than layers, or the number of layers was not taken from 8.9: "
     "it depends on the connectivity alone, and is the same in all GOFs.",
     "Distribute exactly NumLayers layers; the last group takes the rest. Compare NumLayers "
     "with that of another decoder if the numbers look right."},
    {"R-BON-04", "7.11.2", "The parent of a bone is not an earlier bone.",
     "Bones were written in the order of the input, or the index of the parent was written "
     "without adding 1.",
     "Sort bones so that parents come first; 0 is for a bone without parent."},
    {"R-BON-05", "7.11.2",
     "The step of rotations, origins or stretches has an index above 239.",
     "A step was written instead of its index, or the index was computed in another unit.",
     "See 8.12.1: eight indices double the step."},
    {"R-BON-06", "7.11", "More adaptive trajectories are announced than a GOF can have.",
     "A large number was written to make all trajectories adaptive.",
     "Write at most MaxComponents of the level; the number of trajectories is enough."},
    {"R-CLP-01", "7.15", "There are too many clips.",
     "Each frame was made a clip; or the payload is damaged.",
     "Write at most 4096 clips into the table."},
    {"R-CLP-02", "7.15", "A clip has frames that the sequence does not have.",
     "clip_gap was counted from the start of the clip before, not from its end; or the stream "
     "was cut, but its clip table was not changed.",
     "Count clip_gap from the end of the clip before, and clip_num_frames_minus1 up to the "
     "last "
     "frame of the sequence."},
    {"R-CLP-03", "7.15", "The name of a clip is not UTF-8 without control characters.",
     "A name in another encoding, or with a terminating zero byte or a line break.",
     "Write names in UTF-8, without a zero at the end."},
    {"R-CON-01", "7.4.1", "There are more degenerate triangles than triangles.",
     "num_triangles of the sequence header counts the regular triangles alone.",
     "num_triangles counts all triangles; the degenerate ones are its last."},
    {"R-CON-02", "7.4.3",
     "A component starts, but all vertices have occurred and vertex_reuse_flag is 0.",
     "NumVertices is smaller than the vertices in use, or the mesh has vertices where several "
     "fans of triangles meet and vertex_reuse_flag was not set.",
     "Set vertex_reuse_flag if any vertex has more than one vertex instance; check "
     "num_vertices_minus1."},
    {"R-CON-03", "7.4.5", "A reused vertex has not occurred before.",
     "reused_vertex was written in the numbering of the input, not in that of decoding; or "
     "with "
     "another number of bits than CeilLog2( NumCodedVertices ).",
     "Number vertices in the order in which they first occur in the traversal."},
    {"R-CON-04", "7.4.4",
     "The third corner of a triangle is at a node that is no longer on the border, is the "
     "gate, "
     "or follows the gate.",
     "The border of the encoder differs from that of 8.7: the choice of the gate, the order of "
     "Touch( ), or a flag that had to be written and was not.",
     "Trace the gates of both sides and find the first that differs; see also close_flag and "
     "the two glue flags, which come before a join."},
    {"R-CON-05", "7.4.7", "A corner of a degenerate triangle is no vertex of the mesh.",
     "The index was written in another numbering, or with another number of bits than "
     "CeilLog2( NumVertices ).",
     "Write indices in decoded order, most significant bit first."},
    {"R-END-01", "7.1",
     "The GOFs have more or fewer frames together than the sequence header announces.",
     "num_frames_minus1 was written before the number of frames was known, or the last GOF was "
     "not written.",
     "Correct num_frames_minus1, or write the missing GOFs."},
    {"R-END-02", "7.1", "Bytes follow the end_of_sequence unit.",
     "Two streams were joined, or the file was written over a longer one without being cut.",
     "End the file with the end_of_sequence unit. Streams cannot be joined by joining files."},
    {"R-END-03", "7.8",
     "index_distance does not lead to a GOF index unit that ends where the end_of_sequence "
     "unit "
     "starts.",
     "The distance was counted to the end of the unit, to its payload, or from the start of "
     "the "
     "stream; or a unit was inserted after it was computed.",
     "Write the size of the whole GOF index unit (payload + 9), or 0 if there is none, and the "
     "index directly before the end."},
    {"R-FRM-01", "7.14", "The step of an inter GOF is above 2^12 grid units.",
     "The step was written in other units than 1/16 grid units.",
     "Write the step in 1/16 grid units, minus 1."},
    {"R-FRM-02", "7.14.2", "A frame unit has a frame or a layer group that its GOF lacks.",
     "frame_idx counts from the start of the sequence, or reading is out of step.",
     "Count frames from the start of the GOF, and layer groups from the coarsest, both from "
     "0."},
    {"R-FRM-03", "7.14.2", "A frame unit does not continue its GOF.",
     "A unit was lost or left out while later ones of its layer group stayed, or units of "
     "frames "
     "were mixed.",
     "Write frames in order, each with its layer groups from the coarsest on; once a frame "
     "lacks "
     "a layer group, so do all later ones of the GOF."},
    {"R-FRM-04", "7.14.2", "A GOF ends before frames that have been coded.",
     "gof_end_flag was sent with a frame_idx that is too small, or within a period whose "
     "frames "
     "are coded in another order if the period is cut off.",
     "End a GOF after the last frame that has been coded; in a pattern with two references, "
     "before the first frame of a period that is cut off."},
    {"R-FRM-05", "7.14.1", "The period of a dyadic pattern is not 2, 4, 8, 16, 32 or 64.",
     "pattern_period_log2 was written as the period itself, or is 0.",
     "Write a logarithm of 1 to 6; with a period of one frame, frame_pattern_idc is 0."},
    {"R-FRM-06", "7.14.1", "The pattern of an inter GOF is not one.",
     "A frame of the period is missing or comes twice, a reference comes after the frame that "
     "it "
     "predicts, or depths are too small.",
     "List every frame of the period once, after its references, with a depth that is not less "
     "than theirs; the last frame of the period has depth 0."},
    {"R-FRM-07", "7.14.1", "A pattern has more temporal layers than depths.",
     "The number of layers was taken from another pattern.",
     "A pattern has at most as many temporal layers as its frames have depths."},
    {"R-FRM-08", "7.14.2",
     "An earlier frame is too far back, before the GOF, or of a higher temporal layer.",
     "The distance was counted in output order, or across the start of the GOF.",
     "Count frames in coding order; repeat only frames that are still there if temporal layers "
     "are left out."},
    {"R-FRM-09", "7.14.2", "A frame unit has more frames than its temporal layer has left.",
     "Frames of other temporal layers were counted; or in an open-ended stream, a unit goes on "
     "where the temporal layer changes.",
     "Count the frames of one temporal layer, up to the last of the GOF; in an open-ended "
     "stream, begin a new unit where the temporal layer changes."},
    {"R-FRM-10", "7.14.2", "frame_step_delta is out of range.",
     "The step of a frame is not from a sixteenth to 16 times that of its depth.",
     "Keep frame_step_delta between -15 and 240; begin a GOF with other steps for more."},
    {"R-GOF-01", "7.5", "A GOF does not begin with the frame after the GOF before.",
     "A GOF was left out, repeated or reordered; or first_frame is not counted from the "
     "start of the sequence.",
     "Write GOFs in order; first_frame is the number of frames of all GOFs before."},
    {"R-GOF-02", "7.5", "A GOF has more frames than the sequence has left.",
     "The last GOF is written with the nominal length of a GOF.",
     "Shorten the last GOF to the frames that are left, or correct num_frames_minus1."},
    {"R-GOF-03", "7.5", "fraction_bits is above 24.",
     "The scale of the factors was chosen without regard to the range.",
     "Use fewer fraction bits, and larger steps for the spatial values."},
    {"R-GOF-04", "7.5", "The step of seed residuals is above 65536.",
     "The step was computed in other units than those of the grid, or for a grid far finer "
     "than "
     "the target needs.",
     "Use a coarser grid, so that steps stay small."},
    {"R-GOF-05", "7.5", "seed_predictor is above 4.",
     "A predictor was written that this version does not have; or reading is out of step.",
     "Write the order of the predictor, 0 to 4; see the elements before if it looks like "
     "noise."},
    {"R-GOF-06", "7.5.2", "A seed vertex is no vertex of the mesh.",
     "The index was written in the numbering of the input, with another number of bits than "
     "CeilLog2( NumVertices ), or reading is out of step.",
     "Write seed vertices in decoded order; compare range-coder states at lcf_flag."},
    {"R-GOF-07", "7.5.2", "Two of the three seed vertices of a cluster are the same.",
     "A degenerate triangle of the mesh was taken as seed triangle.",
     "Choose three different vertices; equal positions are allowed, equal indices are not."},
    {"R-GOF-08", "7.5.3", "A vertex belongs to a cluster that does not exist.",
     "cluster_idx counts from 1, or clusters were removed after vertices had been assigned to "
     "them.",
     "Number clusters from 0 to num_clusters_minus1 after the last change."},
    {"R-GOF-09", "7.5.5",
     "The number of components of a cluster is negative or above the level.",
     "num_components_delta is not relative to the previous cluster; or the level is "
     "too low.",
     "The delta is relative to the previous cluster, to 0 for the first; raise level_idc if "
     "the "
     "cluster needs that many."},
    {"R-GOF-10", "7.5.7", "ScaleIdx is outside 0 to 127.",
     "The difference is not relative to the previous component, or the first one "
     "not to 0.",
     "Take differences from the previous component, also across clusters."},
    {"R-GOF-11", "7.5.7", "SpatialBits is outside 1 to 24.",
     "The spatial values need more than 24 bits, or the difference is not relative to the "
     "previous "
     "component.",
     "Use a larger step for spatial values; the first difference is from 1."},
    {"R-GOF-12", "7.5.7", "TemporalBits is outside 1 to 26.",
     "The temporal factor needs more than 26 bits after scaling, or the difference was taken "
     "from another component.",
     "Use fewer fraction bits or a smaller ScaleIdx; the first difference is from 1."},
    {"R-HDR-01", "7.3", "The profile is not known to this version.",
     "The stream is of a later version, or reserved values were used.",
     "Write profile_idc 0 (Baseline) with version 1.0, 1 (Main) with version 1.1, or validate "
     "with a later version."},
    {"R-HDR-02", "7.3", "The level is not known to this version.",
     "level_idc counts from 0, or the stream is of a later version.",
     "Write the lowest level of Table B-1 whose limits hold."},
    {"R-HDR-03", "7.3", "A part of the frame rate is above 2^32 - 1.",
     "A floating-point rate was turned into a fraction without reducing it, or the 0 of an "
     "unknown rate became -1.",
     "Reduce the fraction; write 1/1 if the rate is unknown."},
    {"R-HDR-04", "7.3", "The step of the grid is not a power of two from 2^-150 to 2^120.",
     "The exponent has the wrong sign, or belongs to a value in another unit.",
     "Choose the step so that the coordinates are normal 32-bit numbers."},
    {"R-HDR-05", "7.3", "The origin of the grid is more than 2^26 steps away.",
     "A small object far from the origin of space: the step is too fine for the distance.",
     "Use a coarser step, or move the animation towards the origin."},
    {"R-HDR-06", "7.3", "Positions have fewer than 2 or more than 24 bits.",
     "The bits of the grid were computed from a bounding box without regard to the range.",
     "Use a coarser step of the grid, or at least 2 bits for an object without size."},
    {"R-HSH-01", "7.7", "A GOF hash unit has neither one hash for the GOF, nor one per frame.",
     "per_frame_flag does not match what was written, or the unit belongs to another GOF.",
     "With per_frame_flag 1, write 4 bytes per frame of the preceding GOF; otherwise 4 bytes."},
    {"R-HSH-02", "7.7", "The decoded positions do not match the hash in the stream.",
     "The encoder's reconstruction deviates from clause 8 (rounding, clipping, order of "
     "predictions), hashes its input, or hashes in output order.",
     "Compare the reconstruction frame by frame with that of a decoder; the hash is over "
     "32-bit "
     "integers, low byte first, in decoded order."},
    {"R-HSH-03", "7.2", "A GOF hash unit does not follow a GOF unit directly.",
     "Another unit was written between them, or a second hash unit for the same GOF.",
     "Write the hash unit right after its GOF and its slices; metadata goes before "
     "the "
     "GOF or after all of them."},
    {"R-IDX-01", "7.9", "The GOF index does not list all frames of the sequence once.",
     "The index was written before the last GOF, or num_index_gofs_minus1 is not one less than "
     "the number of GOFs.",
     "Write the index after all GOFs, with one entry for each."},
    {"R-IDX-02", "7.9", "An offset of the GOF index is above 2^32 - 2.",
     "The stream has more than 4 GB before its first GOF, or a GOF is that large.",
     "Omit the index (index_distance 0), or use smaller GOFs."},
    {"R-IDX-03", "7.9", "The GOF index does not match the GOF units.",
     "index_gof_bytes leaves out GOF hash units, unit headers or CRCs; or units were inserted "
     "or "
     "removed after the index was made.",
     "Count from the start of a GOF unit to the start of the next GOF unit, with all that is "
     "in "
     "between; rebuild the index when units change."},
    {"R-IDX-04", "7.9", "No decoder finds this GOF index unit.",
     "index_distance is 0, the index is not directly before the end_of_sequence unit, or there "
     "are several.",
     "Write one index directly before the end, and its size into index_distance."},
    {"R-IDX-05", "7.9", "The GOF index lists more shared rigs than the sequence has frames.",
     "Shared rigs were counted once for each GOF that uses them, or reading is out of step.",
     "List each rig unit once; rigs that no frame needs can be omitted."},
    {"R-IDX-06", "7.9", "The shared rigs of the GOF index are not those of the stream.",
     "The distances were counted from GOF units, or units were inserted or removed after the "
     "index was made.",
     "Count from the start of a rig unit to the start of the next; rebuild the index "
     "when units change."},
    {"R-LVL-01", "7.3", "The mesh has more vertices than its level allows.",
     "level_idc was not chosen by the number of vertices.", "Raise level_idc (Table B-1)."},
    {"R-LVL-02", "7.3", "The mesh has more triangles than its level allows.",
     "level_idc was chosen by the number of vertices alone.", "Raise level_idc (Table B-1)."},
    {"R-LVL-03", "7.3", "The sequence has more than 2^24 frames.",
     "An element was written with the wrong size, or the animation is longer than any level "
     "allows.",
     "Split the animation into several streams."},
    {"R-LVL-04", "7.5",
     "A GOF has more frames, or more vertices times frames, than its level allows.",
     "The whole animation was written as one GOF.",
     "Use shorter GOFs, or raise level_idc (Table B-1)."},
    {"R-LVL-05", "7.5.5",
     "A GOF, with all shared rigs, has more factors than its level allows.",
     "Many components, bones or trajectories over many vertices and frames.",
     "Use fewer of them, shorter GOFs or fewer shared rigs at a time, or raise level_idc "
     "(Table B-1)."},
    {"R-LVL-06", "7.5", "A GOF has more clusters, bones or patches than its level allows.",
     "Their number was chosen without regard to the level.",
     "Use fewer of them, or raise level_idc; no level has more than 1024."},
    {"R-LVL-07", "7.2", "A critical unit is larger than its level allows.",
     "The size of the unit was never compared with the level; or unit_size is damaged.",
     "Use shorter GOFs, or raise level_idc (Table B-1)."},
    {"R-LVL-09", "7.11",
     "There are more adaptive trajectories times vertices than the level allows.",
     "num_adaptive_factors was chosen without regard to the size of the mesh.",
     "Let fewer of the trajectories adapt the weights, or raise level_idc (Table B-1)."},
    {"R-LVL-10", "7.14", "The mesh has too many vertices for learned weights.",
     "learning_flag is 1 whatever the size of the mesh.",
     "Write learning_flag 0 for meshes this large, or raise level_idc."},
    {"R-MET-01", "7.10", "The metadata is larger than 1 MiB.",
     "More than a description was put into the metadata.",
     "Keep metadata below 1048576 bytes; large data belongs outside the stream."},
    {"R-MET-02", "7.10", "The metadata is not exactly one zlib stream of metadata_size bytes.",
     "Raw deflate or gzip was written instead of zlib; metadata_size is the compressed size; "
     "or "
     "bytes follow the zlib stream.",
     "Write metadata_size of the text before compression, then the output of compress( )."},
    {"R-MET-03", "7.10", "The metadata is not a JSON text in UTF-8.",
     "Text in another encoding, a byte order mark, a terminating zero byte, a trailing comma, "
     "or single quotes.",
     "Let a JSON library write the text, in UTF-8 without a byte order mark."},
    {"R-MOD-01", "7.13.1", "A GOF uses a shared rig that is not there.",
     "The unit of the rig was lost, or the stream was joined after it; or the GOF has "
     "another "
     "rig_idx than the rig.",
     "Write each shared rig before the first GOF that uses it. When streams are cut or "
     "joined, keep the rigs that the remaining GOFs use."},
    {"R-RNG-01", "9.3.2",
     "A section of the range coder is longer or shorter than its bins need.",
     "The range encoder was flushed with too many or too few bytes, or encoder and decoder "
     "disagree about a rig or a context before.",
     "End the section with the byte after which the decoder stops exactly three bytes past it "
     "(9.3.2); compare with the traces of Annex C. If elements look like noise before the end, "
     "find the first that differs."},
    {"R-RNG-02", "9.3.2", "A section begins with four bytes of 255.",
     "A carry of the range encoder was lost, or the section was overwritten.",
     "Propagate carries into the bytes already written."},
    {"R-RST-01", "7.12.4",
     "A vertex has a new counterpart through a hinge that does not exist.",
     "Hinges were numbered in another order, or those of vertices that are still to come are "
     "in "
     "the list.",
     "Compare the order of the vertices and the hinges of each (8.18.2) with another decoder."},
    {"R-SLI-01", "7.12",
     "A slice belongs to a component group, layer group or temporal layer that does not exist.",
     "The groups were counted differently from the GOF unit: 0 is for influences and rest "
     "positions, component groups count from 1, layer groups and temporal layers from 0.",
     "Compare num_component_groups, num_layer_groups_minus1 and num_temporal_layers_minus1 of "
     "the GOF unit."},
    {"R-SLI-02", "7.12", "A slice is out of place, or one that it needs is missing.",
     "A slice was dropped, repeated or moved, but others that depend on it were kept.",
     "All layer groups of component group 0 come first, then those of group 1, and so on; the "
     "component groups of temporal layer 1 follow, then those of the next. To cut a stream, "
     "drop with a slice those of higher layer groups and temporal layers of its component "
     "group, and those of higher component groups in its layer group and temporal layer."},
    {"R-SLI-03", "7.12.1",
     "A component group has no trajectories, or the GOF more than its level allows.",
     "An empty group was written, or the number of trajectories was never compared with the "
     "level.",
     "Omit empty groups; use fewer trajectories, or raise level_idc (Table B-1)."},
    {"R-SLI-04", "7.12.2", "An extra bone does not exist, or already influences the vertex.",
     "Bones that vertices of the ring have were written as extra bones, or the candidates are "
     "not those of 8.13.",
     "Compare the candidates of the vertex with those of another decoder; they come from the "
     "decoded influences of its ring."},
    {"R-SLI-05", "7.12.2", "The weights of the extra bones of a vertex add up to too much.",
     "Weights were rounded one by one, so that their sum is above 2^weight_bits.",
     "Round weights so that their sum is right, extra bones first."},
    {"R-STR-01", "7.1", "The file does not begin with the signature of RLPC.",
     "It is not an RLPC file, or a text-mode transfer changed line endings or the first byte.",
     "Transfer it in binary mode; the first bytes are 89 52 4C 50 43 0D 0A 1A."},
    {"R-STR-02", "7.1", "The major version of the stream is not known.",
     "The stream is of a later version, or the version was not written.",
     "Write version 1.0 or 1.1, or validate with a later version."},
    {"R-STR-03", "7.1",
     "The minor version of the stream is not known, or is not that of its profile.",
     "The stream uses a later minor version, or the encoder always writes its own version.",
     "Write the lowest version that has the tools in use, or validate with a later version."},
    {"R-TRK-01", "7.11", "There are more temporal layers than levels of tracks.",
     "num_temporal_layers_minus1 was written without regard to track_levels, or without "
     "subtracting 1.",
     "Each temporal layer but the first is one level: there are at most track_levels + 1."},
    {"R-UNT-01", "7.2", "The stream ends where another unit must follow.",
     "The file was cut off between units, or the end_of_sequence unit was not written.",
     "End every stream with an end_of_sequence unit."},
    {"R-UNT-02", "7.2", "A unit goes past the end of the stream.",
     "The file was cut off, or unit_size is wrong: byte order, or counted with header and CRC.",
     "unit_size is the payload alone, most significant byte first."},
    {"R-UNT-03", "7.2", "The CRC of a unit does not match.",
     "The bytes were damaged; or the CRC was computed without the unit header, with another "
     "polynomial, or written low byte first.",
     "CRC-32 of zlib over type, size and payload, written most significant byte first."},
    {"R-UNT-04", "7.2", "A critical unit has a type that this version does not know.",
     "The stream is of a later version; or a private unit was written as a critical one.",
     "Private units are ancillary ones: set ancillary_flag."},
    {"R-UNT-05", "7.2", "A unit is out of place.",
     "Units are written in another order than that of Table 7-1, or twice.",
     "Order: sequence header, connectivity, vertex order, GOFs, skinned ones with their "
     "slices right after them, end of sequence."},
    {"R-VOR-01", "7.6", "The vertex order contains an index that no vertex has.",
     "The differences were not taken from VertexOrder, or reading is out of "
     "step.",
     "Write VertexOrder[ v ], the index in the output of vertex v in decoded order."},
    {"R-VOR-02", "7.6", "Two vertices have the same place in the output.",
     "The list was inverted for only a part of the vertices, or vertices were merged after it "
     "was made.",
     "VertexOrder is a permutation of all vertices."},
});

constexpr std::array kWarnings = std::to_array<RuleExplanation>({
    {"W-BON-01", "7.11.2", "A bone moves no vertex.",
     "Bones that lost their last vertex to others were kept; they cost bits to no effect.",
     "Remove bones that influence no vertex and have no descendant that does, before the GOF "
     "is written."},
    {"W-CLP-01", "7.15", "Several clip tables: only the last one counts.",
     "A tool added a table without removing the old one.", "Keep one clip table."},
    {"W-GOF-01", "7.5.3", "A cluster has no coded vertices.",
     "Clusters that became empty were kept; they cost bits to no effect.",
     "Remove empty clusters before the GOF is written."},
    {"W-GOF-02", "7.5.7", "A component is zero everywhere.",
     "All its temporal or all its spatial residuals became zero by quantisation.",
     "Omit components that quantise to zero."},
    {"W-HDR-01", "7.3", "The frame rate is implausible.",
     "Numerator and denominator are exchanged, or the rate is the duration of a frame.",
     "Frames per second: 30/1, or 30000/1001."},
    {"W-HSH-01", "7.7", "GOFs have no hash.", "The encoder was set to omit them.",
     "Write a hash for each GOF: decoders cannot detect differences without one."},
    {"W-IDX-01", "7.9", "Many GOFs, but no GOF index.", "The encoder writes none.",
     "Write one: without it, finding a frame means walking over all units."},
    {"W-LVL-01", "7.3", "The level is higher than the stream needs.",
     "The encoder always writes the same level.",
     "Write the lowest level whose limits hold, so that more decoders accept the stream."},
    {"W-MET-01", "7.10", "Several metadata units: only the last one counts.",
     "A tool added metadata without removing the old ones.", "Keep one metadata unit."},
    {"W-MOD-01", "7.13", "No GOF uses a shared rig.",
     "The rig was replaced too early, or all its GOFs were removed or coded without it.",
     "Write a shared rig only if a GOF uses it."},
    {"W-SLI-01", "7.12.1", "A trajectory is zero in all frames.",
     "All its residuals became zero by quantisation.",
     "Omit trajectories that quantise to zero; in a skinned GOF with a shared rig, write "
     "trajectory_flag 0."},
    {"W-UNT-01", "7.2", "An ancillary unit of a type that this version does not know.",
     "A private unit, a unit of a later version, or a damaged type.",
     "Decoders skip it; make sure that nothing depends on it."},
});

}  // namespace

std::span<const RuleExplanation> rule_explanations() { return kRules; }
std::span<const RuleExplanation> warning_explanations() { return kWarnings; }

const RuleExplanation* explain(std::string_view id) {
  for (const auto table : {rule_explanations(), warning_explanations()}) {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const RuleExplanation& e) { return id == e.id; });
    if (found != table.end()) return &*found;
  }
  return nullptr;
}

}  // namespace rlpc
