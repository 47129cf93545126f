// SPDX-License-Identifier: Apache-2.0
// Every table and key of a project file, declared once: the reader accepts these, and the JSON
// Schema for editors is made from them.
#pragma once

#include <string>
#include <vector>

namespace exitance {

struct ProjectKey {
    enum class Kind {
        text,
        number,
        count,  ///< a whole number
        flag,
        pair,      ///< two numbers
        vector,    ///< three numbers
        turn,      ///< [x, y, z, degrees]
        spectrum,  ///< a number or three
        points,    ///< a list of three or four vectors
        time,      ///< a date and time of day
        unit       ///< a word or a number of metres
    };
    std::string name;
    Kind kind;
    std::string what;  ///< one line
    bool required = false;
    std::vector<std::string> choices{};
};

struct ProjectTable {
    std::string name;
    bool repeated = true;  ///< [[name]] rather than [name]
    std::string what;
    std::vector<ProjectKey> keys;
    bool open = false;  ///< may have other keys, which are options or names
};

/// The tables of a project, and first, without a name, the keys above all tables.
const std::vector<ProjectTable>& project_tables();
/// Names of the keys of a table; of the top level ("") those of its keys and of all tables.
std::vector<std::string> project_keys(const std::string& table);

}  // namespace exitance
