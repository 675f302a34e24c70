#include "common/files/output_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/scratch_folder.h"

namespace {
int num_syncs = 0;
int sync_error = 0;  // 0: none
}  // namespace

// Replaces the function of the system.
extern "C" int fsync(int /*file*/) {
  ++num_syncs;
  errno = sync_error;
  return sync_error == 0 ? 0 : -1;
}

namespace rlpc {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public ScratchFolderTest {
 protected:
  std::size_t num_files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  // Writes a whole file; returns the error message, or "".
  std::string write(const std::string& name, const std::string& text) const {
    auto file = OutputFile::create(path(name));
    if (!file) return file.error().message;
    const auto error = write_and_commit(*file, text);
    return error ? error->message : "";
  }
};

TEST_F(OutputFileTest, AppearsOnlyWhenComplete) {
  put("a", "before");
  {
    auto file = OutputFile::create(path("a"));
    ASSERT_TRUE(file);
    EXPECT_FALSE(file->write("after"));
    EXPECT_FALSE(file->close());
    EXPECT_EQ(content("a"), "before");
    EXPECT_EQ(content("a.partial"), "after");
    EXPECT_FALSE(file->commit());
  }
  EXPECT_EQ(content("a"), "after");
  EXPECT_EQ(num_files(), 1);
}

TEST_F(OutputFileTest, IsRemovedUnlessCommitted) {
  put("a", "before");
  for (const bool closed : {false, true}) {
    auto file = OutputFile::create(path("a"));
    ASSERT_TRUE(file);
    EXPECT_FALSE(file->write("after"));
    EXPECT_FALSE(closed ? file->close() : std::nullopt);
  }
  EXPECT_EQ(content("a"), "before");
  EXPECT_EQ(num_files(), 1);
}

TEST_F(OutputFileTest, IsFlushedBeforeItIsRenamed) {
  num_syncs = 0;
  auto file = OutputFile::create(path("a"));
  ASSERT_TRUE(file);
  EXPECT_FALSE(file->close());
  EXPECT_EQ(num_syncs, 1);
  EXPECT_FALSE(file->commit());
  EXPECT_EQ(num_syncs, 2);  // the folder
}

TEST_F(OutputFileTest, IsNotCommittedIfTheDiskFails) {
  put("a", "before");
  sync_error = EIO;
  EXPECT_NE(write("a", "after").find("cannot write: Input/output error"), std::string::npos);
  EXPECT_EQ(content("a"), "before");
  EXPECT_EQ(num_files(), 1);
  sync_error = EINVAL;  // cannot be synced
  EXPECT_EQ(write("a", "after"), "");
  sync_error = 0;
}

TEST_F(OutputFileTest, DoesNotTouchForeignFiles) {
  put("a.partial", "of another process");
  EXPECT_EQ(write("a", "text"), "");
  EXPECT_EQ(content("a"), "text");
  EXPECT_EQ(content("a.partial"), "of another process");
}

fs::perms permissions(const std::string& path) { return fs::status(path).permissions(); }

TEST_F(OutputFileTest, KeepsThePermissionsOfTheReplacedFile) {
  const mode_t before = umask(022);
  put("a", "before");
  for (const unsigned mode : {0600U, 0644U, 0666U, 0640U, 0755U}) {
    fs::permissions(path("a"), fs::perms{mode});
    auto file = OutputFile::create(path("a"));
    ASSERT_TRUE(file);
    EXPECT_EQ(permissions(path("a.partial")), fs::perms{mode});  // from the beginning
    EXPECT_FALSE(write_and_commit(*file, "after"));
    EXPECT_EQ(permissions(path("a")), fs::perms{mode});
  }
  EXPECT_EQ(write("new", ""), "");
  EXPECT_EQ(permissions(path("new")), fs::perms{0644});
  umask(before);
}

TEST_F(OutputFileTest, FollowsLinks) {
  fs::create_directory(path("far"));
  put("far/there", "before");
  fs::create_symlink("far/there", path("to_file"));
  fs::create_symlink("far/not_yet", path("to_nothing"));
  fs::create_symlink(path("to_nothing"), path("to_link"));
  EXPECT_EQ(write("to_file", "1"), "");
  EXPECT_EQ(write("to_nothing", "2"), "");
  EXPECT_EQ(content("far/there"), "1");
  EXPECT_EQ(content("far/not_yet"), "2");
  EXPECT_EQ(write("to_link", "3"), "");
  EXPECT_EQ(content("far/not_yet"), "3");
  for (const char* link : {"to_file", "to_nothing", "to_link"}) {
    EXPECT_TRUE(fs::is_symlink(path(link))) << link;
  }
  fs::remove(path("far/not_yet"));
  EXPECT_TRUE(OutputFile::is_same_file(path("to_link"), path("far/not_yet")));
}

TEST_F(OutputFileTest, RefusesUnresolvableLinks) {
  fs::create_symlink("none/a", path("to_no_folder"));
  fs::create_symlink("round", path("round"));
  EXPECT_NE(write("to_no_folder", "").find("there is no folder"), std::string::npos);
  EXPECT_NE(write("round", "").find("cannot follow the link"), std::string::npos);
  EXPECT_EQ(num_files(), 2);
}

TEST_F(OutputFileTest, SupportsNamesOfMaximumLength) {
  const auto longest = static_cast<std::size_t>(pathconf(folder_.c_str(), _PC_NAME_MAX));
  for (std::size_t size = longest - 10; size <= longest; ++size) {
    const std::string name(size, 'n');
    EXPECT_EQ(write(name, "text"), "") << size;
    EXPECT_EQ(content(name), "text");
  }
  const std::string name = std::string(longest % 2, 'n') + [&] {
    std::string text;  // characters of two bytes
    while (text.size() + 2 <= longest) text += "\xC3\xA4";
    return text;
  }();
  ASSERT_EQ(name.size(), longest);
  auto file = OutputFile::create(path(name));
  ASSERT_TRUE(file);
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string other = entry.path().filename().string();
    if (!other.ends_with(".partial")) continue;
    const std::size_t stem = other.size() - std::string(".partial").size();
    EXPECT_EQ(name.substr(0, stem), other.substr(0, stem));
    EXPECT_EQ(stem % 2, longest % 2);
  }
}

TEST_F(OutputFileTest, ReportsWhyAPlaceIsUnusable) {
  EXPECT_NE(write("none/a", "").find("there is no folder"), std::string::npos);
  EXPECT_NE(write("", "").find("is a folder"), std::string::npos);
}

TEST_F(OutputFileTest, RecognisesTheSameFileByOtherNames) {
  put("a", "");
  put("b", "");
  fs::create_symlink("a", path("link"));
  fs::create_hard_link(path("a"), path("hard"));
  const auto same = [&](const std::string& x, const std::string& y) {
    return OutputFile::is_same_file(path(x), path(y));
  };
  EXPECT_TRUE(same("a", "./a"));
  EXPECT_TRUE(same("a", "link"));
  EXPECT_TRUE(same("hard", "a"));
  EXPECT_TRUE(same("none", "./none"));
  EXPECT_FALSE(same("a", "b"));
  EXPECT_FALSE(same("none", "nothing"));
  EXPECT_FALSE(OutputFile::is_same_file("/dev/null", "/dev/null"));
  EXPECT_FALSE(OutputFile::is_same_file("-", "-"));
}

using TemporaryFolderTest = OutputFileTest;

TEST_F(TemporaryFolderTest, AppearsCompleteOrNotAtAll) {
  for (const bool committed : {false, true}) {
    auto folder = TemporaryFolder::create(path("new"));
    ASSERT_TRUE(folder);
    auto file = OutputFile::create_within(folder->path() + "/a");
    ASSERT_TRUE(file);
    EXPECT_FALSE(file->write("text"));
    EXPECT_FALSE(file->close());
    EXPECT_FALSE(folder->sync());
    if (committed) {
      EXPECT_FALSE(folder->commit(path("new")));
    }
  }
  EXPECT_EQ(content("new/a"), "text");
  EXPECT_EQ(num_files(), 1);
}

TEST_F(TemporaryFolderTest, FilesKeepPermissionsAndFollowLinks) {
  put("a", "before");
  put("far", "before");
  fs::permissions(path("a"), fs::perms{0600});
  fs::create_symlink("far", path("b"));
  {
    auto folder = TemporaryFolder::create(folder_.string());
    ASSERT_TRUE(folder);
    EXPECT_EQ(permissions(folder->path()), fs::perms::owner_all);
    for (const std::string name : {"a", "b"}) {
      auto file = OutputFile::create_within(folder->path() + "/" + name);
      ASSERT_TRUE(file);
      EXPECT_FALSE(file->write("after"));
      EXPECT_FALSE(file->close());
      EXPECT_FALSE(folder->commit_file(name, path(name)));
    }
  }
  EXPECT_EQ(content("a"), "after");
  EXPECT_EQ(permissions(path("a")), fs::perms{0600});
  EXPECT_EQ(content("far"), "after");
  EXPECT_TRUE(fs::is_symlink(path("b")));
  EXPECT_EQ(num_files(), 3);
}

}  // namespace
}  // namespace rlpc
