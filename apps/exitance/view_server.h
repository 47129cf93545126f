// SPDX-License-Identifier: Apache-2.0
// Serves the walkthrough and one solution to browsers on this machine, and to nobody else.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace exitance::cli {

/// What a page asks of a solve that is running.
enum class ViewCommand { pause, resume, stop };

/// Listens on 127.0.0.1 from construction to destruction, on threads of its own. Everything lies
/// below a path that nobody can guess. Refused are hosts other than the loopback (a name of
/// elsewhere that leads here), requests that another site's page makes, every path but those of
/// the page and its solution, every method but GET, HEAD and the page's commands, and bodies beyond
/// a kilobyte.
class ViewServer {
  public:
    /// `port` 0: any that is free. Throws Error(could_not_finish) if it cannot be had.
    explicit ViewServer(int port);
    ~ViewServer();
    ViewServer(const ViewServer&) = delete;
    ViewServer& operator=(const ViewServer&) = delete;

    /// What to open: "http://127.0.0.1:PORT/TOKEN/".
    const std::string& url() const;

    /// From now on pages show this file; those that are open load it. It is held open: replacing
    /// or removing it does not disturb. Throws Error(could_not_finish) if it cannot be read.
    void show(const std::filesystem::path& solution);
    /// Tells the open pages how far a solve is: a JSON object.
    void tell_progress(const std::string& json);
    /// Called from a thread of the server.
    void on_command(std::function<void(ViewCommand)> heard);

    /// Whether a page was open and for some seconds none has been.
    bool deserted() const;
    bool has_pages() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace exitance::cli
