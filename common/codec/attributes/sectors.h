// Sectors: the corners at a vertex that share a value (F.4), and the order in which their
// values are coded (F.5).
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/topology.h"
#include "common/memory/owned.h"

namespace rlpc {

struct Sectors {
  Vector<std::uint32_t> sector_of_corner;  // SectorOf
  ListOfLists<std::uint32_t> corners;      // SectorCorners

  std::uint32_t count() const { return static_cast<std::uint32_t>(corners.size()); }
};

// F.4 MakeSectors( ): sectors of corners, from the edges that are seams, or of vertices.
Sectors sectors_of_corners(std::span<const std::uint32_t> edge_mates,
                           const Vector<bool>& seams);
Sectors sectors_of_vertices(std::uint32_t num_vertices, std::span<const Triangle> triangles);
// Returns the corners of each sector, ascending. sector_of_corner: sectors below num_sectors.
ListOfLists<std::uint32_t> corners_of_sectors(std::uint32_t num_sectors,
                                              std::span<const std::uint32_t> sector_of_corner);

inline constexpr std::size_t kMaxSectorTriangles = 8;
inline constexpr std::size_t kMaxSectorRing = 8;
inline constexpr std::uint32_t kNoSector = 0xFFFFFFFF;
inline constexpr std::size_t kSectorClasses = 4;

// F.5 MakeSectorOrder( )
struct SectorOrder {
  explicit SectorOrder(const Sectors& sectors);

  Vector<std::uint32_t> order;           // SectorOrder
  ListOfLists<std::uint32_t> triangles;  // SectorTriangles: [sector] corners
  ListOfLists<std::uint32_t> ring;       // SectorRing
  Vector<std::uint32_t> neighbour;       // SectorNeighbour; kNoSector: none
  Vector<std::uint8_t> class_of;         // SectorClass
};

}  // namespace rlpc
