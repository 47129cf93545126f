// SPDX-License-Identifier: Apache-2.0
#include "exitance/run/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <sstream>
#include <stdexcept>

namespace exitance {
namespace {

namespace fs = std::filesystem;

class AtomicFileTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("exitance_" + std::string(test->name()) + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static std::string content(const fs::path& path) {
        std::ifstream in(path, std::ios::binary);
        std::ostringstream out;
        out << in.rdbuf();
        return out.str();
    }
    std::size_t files() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    template <class Action>
    static std::string complaint(const Action& action) {
        try {
            action();
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::could_not_finish);
            return error.what();
        }
        ADD_FAILURE() << "nothing was thrown";
        return "";
    }

    fs::path folder_;
};

// Files of this process may not grow beyond `bytes`: what a full disk looks like.
class DiskLimit {
  public:
    explicit DiskLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit now = before_;
        now.rlim_cur = bytes;
        setrlimit(RLIMIT_FSIZE, &now);
    }
    ~DiskLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    DiskLimit(const DiskLimit&) = delete;
    DiskLimit& operator=(const DiskLimit&) = delete;

  private:
    void (*handler_)(int);
    rlimit before_{};
};

TEST_F(AtomicFileTest, AppearsWhole) {
    const fs::path path = folder_ / "a.txt";
    write_atomically(path, [&](std::ostream& out) {
        out << "half";
        out.flush();
        EXPECT_FALSE(fs::exists(path)) << "nothing to see before the end";
        out << " and half";
    });
    EXPECT_EQ(content(path), "half and half");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, AnExceptionLeavesTheOldFile) {
    const fs::path path = folder_ / "a.txt";
    write_atomically(path, [](std::ostream& out) { out << "old"; });
    EXPECT_THROW(write_atomically(path,
                                  [](std::ostream& out) {
                                      out << "new";
                                      throw std::runtime_error("stopped");
                                  }),
                 std::runtime_error);
    EXPECT_EQ(content(path), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, AFullDiskLeavesNothing) {
    const fs::path path = folder_ / "a.txt";
    std::string message;
    {
        const DiskLimit limit(100'000);
        message = complaint([&] {
            write_atomically(path, [](std::ostream& out) { out << std::string(1'000'000, 'x'); });
        });
    }
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_EQ(files(), 0u);
}

TEST_F(AtomicFileTest, AFullDiskLeavesTheOldFile) {
    const fs::path path = folder_ / "a.txt";
    write_atomically(path, [](std::ostream& out) { out << "old"; });
    {
        const DiskLimit limit(10);
        // Small enough to stay in the stream's buffer until it is closed.
        complaint([&] {
            write_atomically(path, [](std::ostream& out) { out << std::string(100, 'x'); });
        });
    }
    EXPECT_EQ(content(path), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(AtomicFileTest, DevicesAreWrittenInPlaceAndTheirFailuresSeen) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    const std::string message =
        complaint([] { write_atomically("/dev/full", [](std::ostream& out) { out << "x"; }); });
    EXPECT_EQ(message, "cannot write /dev/full: No space left on device");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
    write_atomically("/dev/null", [](std::ostream& out) { out << "x"; });
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, MissingFoldersAndFoldersAreRefusedBeforeWork) {
    EXPECT_NE(complaint([&] {
                  check_writable(folder_ / "missing" / "a.txt");
              }).find("No such file or directory"),
              std::string::npos);
    EXPECT_NE(complaint([&] { check_writable(folder_); }).find("Is a directory"),
              std::string::npos);
    check_writable(folder_ / "a.txt");
    EXPECT_EQ(files(), 0u) << "asking leaves nothing";
}

TEST_F(AtomicFileTest, ASymbolicLinkStays) {
    const fs::path path = folder_ / "real.txt", link = folder_ / "link.txt";
    write_atomically(path, [](std::ostream& out) { out << "old"; });
    fs::create_symlink(path, link);
    write_atomically(link, [](std::ostream& out) { out << "new"; });
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_EQ(content(path), "new");
}

}  // namespace
}  // namespace exitance
