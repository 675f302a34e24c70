#include "decoder/web/player/player_page.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "common/files/bounded_input.h"
#include "common/files/output_file.h"
#include "common/json/json.h"
#include "decoder/meshes/base64.h"

namespace rlpc {
namespace {

namespace fs = std::filesystem;

// Placeholder for streams in the player.
constexpr std::string_view kPlace = "<!-- rlpcdec: streams -->";
// Maximum size of a player page; larger files are not players.
constexpr std::size_t kMaxPlayerBytes = std::size_t{64} << 20;
// Bytes per element: streams are split, because browsers limit the length of strings. A
// multiple of 3, so that only the last element has base64 padding.
constexpr std::size_t kPartBytes = std::size_t{3} << 20;

// Returns the description as text for a script element, in which `</` is escaped.
std::string description(const std::string& name) {
  std::string json = json_text(nlohmann::json{{"name", name}}, -1, true);
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) {
    json.replace(at, 1, "\\u003c");
  }
  return "<script type=\"application/json\" id=\"stream-description\">" + json + "</script>\n";
}

std::optional<OutputError> write_stream(OutputFile& file, ByteSource& source,
                                        const std::string& kind) {
  std::vector<std::uint8_t> part;
  for (std::uint64_t at = 0; at < source.size(); at += part.size()) {
    part.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(kPartBytes, source.size() - at)));
    if (!source.read(at, part)) return OutputError{file.path() + ": cannot read the " + kind};
    const std::string text =
        "<script type=\"text/plain\" class=\"" + kind + "\">" + base64(part) + "</script>\n";
    if (auto error = file.write(text)) return error;
  }
  return std::nullopt;
}

std::vector<fs::path> places_of_player() {
  std::error_code ec;
  const fs::path folder = fs::read_symlink("/proc/self/exe", ec).parent_path();
  return {folder.parent_path() / "share" / "rlpc" / "player.html",  // bin/ next to share/
          folder.parent_path().parent_path() / "player" / "player.html"};  // build/release/bin/
}

}  // namespace

OutputResult<std::string> read_player(const std::string& path) {
  std::vector<fs::path> places{path};
  if (path.empty()) places = places_of_player();
  for (const fs::path& place : places) {
    auto text = read_small_file(place.string(), kMaxPlayerBytes);
    if (!text) continue;
    if (text->find(kPlace) != std::string::npos) return std::move(*text);
    return OutputError{place.string() + ": not the page that scripts/player builds"};
  }
  if (!path.empty()) return OutputError{path + ": cannot read the player"};
  return OutputError{"player not built: run scripts/player first, or pass 'player'"};
}

std::optional<OutputError> write_player_page(const std::string& path, const std::string& player,
                                             const PageStreams& streams,
                                             std::shared_ptr<OutputLimit> limit) {
  for (const ByteSource* source : {streams.stream, streams.reference}) {
    if (source != nullptr && source->size() > kMaxPageStreamBytes) {
      return OutputError{path + ": a page holds streams of up to " +
                         std::to_string(kMaxPageStreamBytes >> 20) + " MiB, not of " +
                         std::to_string(source->size() >> 20)};
    }
  }
  auto file = OutputFile::create(path, std::move(limit));
  if (!file) return file.error();
  const std::size_t place = player.find(kPlace);
  const std::string_view text = player;
  if (auto error = file->write(text.substr(0, place))) return error;
  if (auto error = file->write(description(streams.name))) return error;
  if (auto error = write_stream(*file, *streams.stream, "stream")) return error;
  if (streams.reference != nullptr) {
    if (auto error = write_stream(*file, *streams.reference, "reference")) return error;
  }
  if (auto error = file->write(text.substr(place + kPlace.size()))) return error;
  if (auto error = file->close()) return error;
  return file->commit();
}

}  // namespace rlpc
