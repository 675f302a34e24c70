#include "common/io/output_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

namespace fs = std::filesystem;

class OutputFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("output_file_" + std::to_string(getpid()) + "_" +
               testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string content(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path(name), std::ios::binary).rdbuf();
    return text.str();
  }
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::size_t num_files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  // Writes all of it; the message of what failed, or "".
  std::string write(const std::string& name, const std::string& text) const {
    auto file = OutputFile::create(path(name));
    if (!file) return file.error().message;
    const auto error = write_and_commit(*file, text);
    return error ? error->message : "";
  }

  fs::path folder_;
};

TEST_F(OutputFileTest, TakesItsNameOnlyOnceItIsComplete) {
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

TEST_F(OutputFileTest, LeavesNothingOfWhatIsNotCommitted) {
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

TEST_F(OutputFileTest, WritesNoFileOfOthers) {
  put("a.partial", "of another process");
  EXPECT_EQ(write("a", "text"), "");
  EXPECT_EQ(content("a"), "text");
  EXPECT_EQ(content("a.partial"), "of another process");
}

TEST_F(OutputFileTest, SaysWhatIsWrongWithAPlace) {
  EXPECT_NE(write("none/a", "").find("there is no folder"), std::string::npos);
  EXPECT_NE(write("", "").find("is a folder"), std::string::npos);
}

TEST_F(OutputFileTest, KnowsTheSameFileByOtherNames) {
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

}  // namespace
}  // namespace rlpc
