#pragma once

#include "../cli.h"

#include "gimg/mesh_io.h"
#include "gimg/result.h"

#include <map>
#include <string>
#include <vector>

namespace gimg::gimparam {

/// What all subcommands take: a mesh, how to read it, and where the report goes.
struct Input
{
    std::string path;
    std::string json;
    ReadOptions read;
    bool quiet = false;
};

/// The mesh as the first positional argument, and its options.
void addInput(CLI::App& command, Input& input);

/// An option whose values are names.
template <class Value>
void addChoice(CLI::App& app, const char* name, const std::map<std::string, Value>& values, Value& value,
               const char* text);

/// Reads the mesh. Errors are worded for a terminal and begin with the path.
Result<MeshFile> readInput(const Input& input);

/// Prints what reading changed, unless told to be quiet.
void printWarnings(const Input& input, const MeshFile& file);

/// Writes the report if one is wanted, then the warnings; returns the exit status of the program.
int finish(const Input& input, const MeshFile& file, const nlohmann::ordered_json& report);

/// Prints the error, after `path` if there is one, and returns the exit status that stands for its kind.
int failWith(const Error& error, const std::string& path = {});

} // namespace gimg::gimparam

#include <CLI/App.hpp>

template <class Value>
void gimg::gimparam::addChoice(CLI::App& app, const char* name, const std::map<std::string, Value>& values,
                               Value& value, const char* text)
{
    std::vector<std::string> names;
    for (const auto& entry : values) names.push_back(entry.first);
    app.add_option_function<std::string>(
           name, [values, &value](const std::string& key) { value = values.at(key); }, text)
        ->check(CLI::IsMember(names));
}
