// SPDX-License-Identifier: Apache-2.0
// A hierarchy of boxes, to find those that overlap another without looking at all.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

#include "exitance/math/box.h"

namespace exitance {

class BoxTree {
  public:
    explicit BoxTree(std::span<const Box> boxes)
        : boxes_(boxes.begin(), boxes.end()), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
    }

    /// Calls `visit(std::uint32_t)` for every box that overlaps `box`, in an order that depends on
    /// the boxes alone.
    template <class Visit>
    void for_overlapping(const Box& box, const Visit& visit) const {
        for_accepted([&](const Box& other) { return overlap(other, box); }, visit);
    }
    /// For every box that `accept(const Box&)` takes; it takes all that contain one it takes. A
    /// `visit` that returns false ends it.
    template <class Accept, class Visit>
    void for_accepted(const Accept& accept, const Visit& visit) const {
        if (!nodes_.empty()) walk(0, accept, visit);
    }

  private:
    static constexpr std::uint32_t leaf_size = 4;

    struct Node {
        Box box;
        std::uint32_t begin, end;  ///< into order_, for a leaf
        std::uint32_t right = 0;   ///< the left child follows its parent; 0 = leaf
    };

    static bool overlap(const Box& a, const Box& b) {
        return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
               b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
    }

    void build(std::uint32_t begin, std::uint32_t end) {
        const std::size_t at = nodes_.size();
        Node node{{}, begin, end};
        Box centres;
        for (std::uint32_t i = begin; i < end; ++i) {
            node.box.add(boxes_[order_[i]].lower);
            node.box.add(boxes_[order_[i]].upper);
            centres.add(boxes_[order_[i]].centre());
        }
        nodes_.push_back(node);
        if (end - begin <= leaf_size) return;
        const Vec3 size = centres.size();
        const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0
                                 : size.y >= size.z                   ? 1
                                                                      : 2;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [&](std::uint32_t a, std::uint32_t b) {
                             const double x = boxes_[a].centre()[axis],
                                          y = boxes_[b].centre()[axis];
                             return x != y ? x < y : a < b;
                         });
        build(begin, middle);
        nodes_[at].right = static_cast<std::uint32_t>(nodes_.size());
        build(middle, end);
    }

    template <class Accept, class Visit>
    bool walk(std::size_t at, const Accept& accept, const Visit& visit) const {
        const Node& node = nodes_[at];
        if (!accept(node.box)) return true;
        if (node.right != 0) return walk(at + 1, accept, visit) && walk(node.right, accept, visit);
        for (std::uint32_t i = node.begin; i < node.end; ++i)
            if (accept(boxes_[order_[i]]) && !goes_on(visit, order_[i])) return false;
        return true;
    }

    template <class Visit>
    static bool goes_on(const Visit& visit, std::uint32_t i) {
        if constexpr (std::is_same_v<decltype(visit(i)), bool>) return visit(i);
        visit(i);
        return true;
    }

    std::vector<Box> boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace exitance
