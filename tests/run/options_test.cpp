// SPDX-License-Identifier: Apache-2.0
#include "exitance/run/options.h"

#include <gtest/gtest.h>

#include <limits>

#include "exitance/run/error.h"

namespace exitance {
namespace {

struct Values {
    bool flag = false;
    int count = 3;
    std::uint64_t seed = 0;
    double size = 0.5;
    std::optional<double> limit;
    std::string mode = "fast";
    std::optional<std::string> title;

    Options describe() {
        return {{"flag", &flag, "a flag"},
                {"count", &count, "how many", "", 0, 10},
                {"seed", &seed, "seed"},
                {"size", &size, "how large", "m", 0.1, 2},
                {"limit", &limit, "no more than this", "s", 0},
                {"mode", &mode, "which way", "", 0, 0, {"fast", "exact"}},
                {"title", &title, "what it is called"}};
    }
};

// The message of the Error(wrong_use) that `action` throws.
template <class Action>
std::string complaint(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::wrong_use);
        EXPECT_EQ(error.exit_code(), 2);
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

TEST(Option, SetStoresWhatIsTyped) {
    Values v;
    const Options options = v.describe();
    find_option(options, "flag").set("true");
    find_option(options, "count").set("10");
    find_option(options, "seed").set("18446744073709551615");
    find_option(options, "size").set("1.25e0");
    find_option(options, "limit").set("30");
    find_option(options, "mode").set("exact");
    find_option(options, "title").set("a room, with a view");
    EXPECT_TRUE(v.flag);
    EXPECT_EQ(v.count, 10);
    EXPECT_EQ(v.seed, std::numeric_limits<std::uint64_t>::max());
    EXPECT_EQ(v.size, 1.25);
    EXPECT_EQ(v.limit, 30.0);
    EXPECT_EQ(v.mode, "exact");
    EXPECT_EQ(v.title, "a room, with a view");
}

TEST(Option, ValueTextReadsBackToTheSameValue) {
    Values v;
    const Options options = v.describe();
    EXPECT_EQ(find_option(options, "limit").value_text(), "");
    EXPECT_EQ(find_option(options, "title").value_text(), "");
    EXPECT_EQ(find_option(options, "flag").value_text(), "false");
    EXPECT_EQ(find_option(options, "size").value_text(), "0.5");
    for (const double x : {0.1234567890123456, 1.0 / 3, 2.0, 1.0}) {
        v.size = x;
        v.limit = x * 1e-7;
        const double size = v.size, limit = *v.limit;
        find_option(options, "size").set(find_option(options, "size").value_text());
        find_option(options, "limit").set(find_option(options, "limit").value_text());
        EXPECT_EQ(v.size, size);
        EXPECT_EQ(v.limit, limit);
    }
    v.size = 1;
    EXPECT_EQ(find_option(options, "size").value_text(), "1");
}

TEST(Option, MessagesNameTheOptionTheTextAndTheRange) {
    Values v;
    const Options options = v.describe();
    const auto set = [&](const char* name, const char* text) {
        return complaint([&] { find_option(options, name).set(text); });
    };
    EXPECT_EQ(set("size", "3"), "--size: '3' is not allowed, expected 0.1 … 2");
    EXPECT_EQ(set("size", "wide"), "--size: 'wide' is not allowed, expected 0.1 … 2");
    EXPECT_EQ(set("count", "11"), "--count: '11' is not allowed, expected 0 … 10");
    EXPECT_EQ(set("limit", "-1"), "--limit: '-1' is not allowed, expected at least 0");
    EXPECT_EQ(set("mode", "slow"), "--mode: 'slow' is not allowed, expected one of fast, exact");
    EXPECT_EQ(set("flag", "yes"), "--flag: 'yes' is not allowed, expected true or false");
    EXPECT_EQ(set("seed", "x"), "--seed: 'x' is not allowed, expected a number");
}

TEST(Option, ARefusedValueIsShownAsItWasTyped) {
    Values v;
    const Options options = v.describe();
    EXPECT_EQ(complaint([&] { find_option(options, "size").set("2.0000001"); }),
              "--size: '2.0000001' is not allowed, expected 0.1 … 2");
}

TEST(Option, RefusesWhatIsNotWhollyANumber) {
    Values v;
    const Options options = v.describe();
    for (const char* text :
         {"", " ", "1 ", " 1", "1x", "0x1", "nan", "inf", "-inf", "1e999", "1,5"})
        EXPECT_NE(complaint([&] { find_option(options, "limit").set(text); }), "") << text;
    for (const char* text : {"", "1.5", "99999999999", "-99999999999", "3 "})
        EXPECT_NE(complaint([&] { find_option(options, "count").set(text); }), "") << text;
    for (const char* text : {"-1", "18446744073709551616"})
        EXPECT_NE(complaint([&] { find_option(options, "seed").set(text); }), "") << text;
    EXPECT_FALSE(v.limit.has_value());
    EXPECT_EQ(v.count, 3) << "a refused value changes nothing";
    EXPECT_EQ(v.seed, 0u);
}

TEST(Option, NumbersMayHaveTheirUnit) {
    Values v;
    const Options options = v.describe();
    const auto limit = [&](const char* text) {
        find_option(options, "limit").set(text);
        return *v.limit;
    };
    EXPECT_EQ(limit("30s"), 30);
    EXPECT_EQ(limit("1.5min"), 90);
    EXPECT_EQ(limit("2h"), 7200);
    find_option(options, "size").set("0.25m");
    EXPECT_EQ(v.size, 0.25);
    double share = 0;
    Option{"share", &share, "how much", "", 0, 1}.set("2.5%");
    EXPECT_EQ(share, 0.025);
    for (const char* text : {"30 s", "30m", "30%", "-1s", "s"})
        EXPECT_NE(complaint([&] { limit(text); }), "") << text;
    for (const char* text : {"1mm", "20%", "3m"})
        EXPECT_NE(complaint([&] { find_option(options, "size").set(text); }), "") << text;
}

TEST(Option, CheckTakesTheEndsOfTheRange) {
    Values v;
    const Options options = v.describe();
    const Option& size = find_option(options, "size");
    size.check(0.1);
    size.check(2);
    EXPECT_NE(complaint([&] { size.check(0.0999); }), "");
    EXPECT_NE(complaint([&] { size.check(2.0001); }), "");
    EXPECT_NE(complaint([&] { size.check(std::numeric_limits<double>::quiet_NaN()); }), "");
    EXPECT_NE(complaint([&] {
                  find_option(options, "limit").check(std::numeric_limits<double>::infinity());
              }),
              "");
}

TEST(FindOption, SuggestsTheNearest) {
    Values v;
    const Options options = v.describe();
    EXPECT_EQ(&find_option(options, "mode"), &options[5]);
    EXPECT_EQ(complaint([&] { find_option(options, "sizes"); }),
              "unknown option 'sizes', did you mean 'size'?");
    EXPECT_EQ(complaint([&] { find_option(options, "completely"); }),
              "unknown option 'completely'");
    EXPECT_EQ(complaint([&] { find_option({}, "size"); }), "unknown option 'size'");
}

TEST(Suggestion, OnlyWhatIsNear) {
    const std::vector<std::string> words{"solve", "render", "probe"};
    EXPECT_EQ(suggestion("solv", words), ", did you mean 'solve'?");
    EXPECT_EQ(suggestion("rendering", words), ", did you mean 'render'?");
    EXPECT_EQ(suggestion("prorb", words), ", did you mean 'probe'?");
    EXPECT_EQ(suggestion("", words), "");
    EXPECT_EQ(suggestion("xyzzy", words), "");
    EXPECT_EQ(suggestion("solve", std::vector<std::string>{}), "");
}

TEST(Error, PlaceSaysAsMuchAsIsKnown) {
    EXPECT_EQ((Place{"a.geom", 3, 7}.text()), "a.geom:3:7");
    EXPECT_EQ((Place{"a.geom", 3, 0}.text()), "a.geom:3");
    EXPECT_EQ((Place{"a.geom", 0, 7}.text()), "a.geom");
    const Error error(Place{"a.geom", 3, 7}, "found x, expected y");
    EXPECT_STREQ(error.what(), "a.geom:3:7: found x, expected y");
    EXPECT_EQ(error.exit_code(), 3);
    EXPECT_EQ(Error(Fault::could_not_finish, "").exit_code(), 4);
}

}  // namespace
}  // namespace exitance
