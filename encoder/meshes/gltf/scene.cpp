#include "encoder/meshes/gltf/scene.h"

#include <string>

namespace rlpc {

namespace {

std::string path_of(std::uint32_t node) { return "nodes[" + std::to_string(node) + "]"; }

std::vector<std::optional<std::uint32_t>> find_parents(const std::vector<GltfNode>& nodes,
                                                       GltfErrors& errors) {
  std::vector<std::optional<std::uint32_t>> parent(nodes.size());
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    for (const std::uint32_t child : nodes[n].children) {
      if (parent[child]) {
        errors.expected(path_of(n) + ".children", std::to_string(child),
                        "no node that is a child of " + path_of(*parent[child]) + " already");
      }
      parent[child] = n;
    }
  }
  return parent;
}

// Returns the nodes below `roots`, each before its children, which keep their order.
std::vector<std::uint32_t> depth_first(const std::vector<GltfNode>& nodes,
                                       const std::vector<std::uint32_t>& roots) {
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> stack(roots.rbegin(), roots.rend());
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    order.push_back(node);
    const std::vector<std::uint32_t>& children = nodes[node].children;
    stack.insert(stack.end(), children.rbegin(), children.rend());
  }
  return order;
}

// Returns a node that is its own ancestor. All nodes must have at most one parent, and not all
// may be below a root.
std::uint32_t node_of_cycle(const GltfScene& scene) {
  std::vector<bool> reached(scene.parent.size());
  for (const std::uint32_t node : scene.parents_first) reached[node] = true;
  std::uint32_t node = 0;
  while (reached[node]) ++node;
  // A node that is not below a root leads upwards into a cycle.
  while (!reached[node]) {
    reached[node] = true;
    node = *scene.parent[node];
  }
  return node;
}

void check_roots(const std::vector<std::uint32_t>& roots, const GltfScene& scene,
                 GltfErrors& errors) {
  std::vector<bool> known(scene.parent.size());
  for (const std::uint32_t root : roots) {
    if (scene.parent[root]) {
      errors.expected("scenes", path_of(root),
                      "nodes without parent; it is a child of " + path_of(*scene.parent[root]));
    } else if (known[root]) {
      errors.expected("scenes", path_of(root) + " twice", "each node once");
    }
    known[root] = true;
  }
}

}  // namespace

GltfScene read_gltf_scene(const GltfDocument& document, GltfErrors& errors) {
  GltfScene scene;
  const std::vector<GltfNode>& nodes = document.nodes;
  scene.parent = find_parents(nodes, errors);
  if (errors) return scene;
  std::vector<std::uint32_t> roots;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) {
    if (!scene.parent[n]) roots.push_back(n);
  }
  scene.parents_first = depth_first(nodes, roots);
  if (scene.parents_first.size() < nodes.size()) {
    errors.expected(path_of(node_of_cycle(scene)), "a node that is its own ancestor",
                    "no cycle of children");
    return scene;
  }
  if (document.scene) {
    check_roots(*document.scene, scene, errors);
    roots = *document.scene;
  }
  if (errors) return scene;
  for (const std::uint32_t node : depth_first(nodes, roots)) {
    if (nodes[node].mesh) scene.with_mesh.push_back(node);
  }
  return scene;
}

}  // namespace rlpc
