// SPDX-License-Identifier: Apache-2.0
#include "view_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <charconv>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include "byte_delta.h"
#include "exitance/run/error.h"
#include "exitance/run/progress.h"
#include "exitance/solution/file.h"
#include "grid_readings.h"
#include "open_file.h"
#include "viewer_assets.h"

namespace exitance::cli {

namespace {

constexpr std::size_t most_body = 1024;
constexpr std::size_t most_past = 3;         // revisions that deltas lead from
constexpr std::size_t most_delta = 1 << 30;  // bytes of a file: both are held at once
constexpr std::size_t threads = 32;          // one per open page, and some for what they load

// Nothing but what this server sends is loaded, run or asked; nobody frames the page.
constexpr const char* security_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// 128 random bits as hexadecimal digits.
std::string make_token() {
    std::random_device device;
    std::string token;
    for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", device());
    return token;
}

/// Takes the same time whichever characters differ.
bool same_text(const std::string& a, const std::string& b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
    return difference == 0;
}

/// Sends some bytes from `offset` on, at most `length`; false if there are none.
bool send(const OpenFile& file, std::size_t offset, std::size_t length, httplib::DataSink& sink) {
    std::vector<char> block(std::min<std::size_t>(length, 1u << 18));
    const std::size_t got = file.read(offset, block);
    return got > 0 && sink.write(block.data(), got);
}

}  // namespace

struct ViewServer::State {
    httplib::Server server;
    std::thread listening;
    std::string token = make_token(), url;
    std::array<std::string, 2> hosts;  ///< as a browser names this server

    mutable std::mutex mutex;
    std::condition_variable news;
    std::shared_ptr<const OpenFile> solution;
    /// Revisions before that of `solution`, the latest first, which pages may still show.
    std::deque<std::shared_ptr<const OpenFile>> past;
    std::mutex reading_grids;
    std::shared_ptr<const OpenFile> grids_of;  ///< the solution that `grids` were read from
    std::string grids;
    std::uint64_t revision = 0;  ///< of the solution; 0 = none yet
    std::uint64_t told = 0;      ///< how often progress was told
    std::string progress;
    std::function<void(ViewCommand)> heard;
    std::size_t pages = 0;
    std::optional<Stopwatch> deserted_since;
    std::atomic<bool> ending = false;

    httplib::Server::HandlerResponse gate(const httplib::Request& request,
                                          httplib::Response& response) const;
    void serve_assets();
    void serve_solution();
    void serve_deltas();
    void serve_grids();
    void serve_events();
    void serve_commands();
    bool send_news(std::uint64_t& seen_revision, std::uint64_t& seen_told, httplib::DataSink& sink);
};

/// Refuses before anything is looked up.
httplib::Server::HandlerResponse ViewServer::State::gate(const httplib::Request& request,
                                                         httplib::Response& response) const {
    const auto refuse = [&](int status, const char* why) {
        response.status = status;
        response.set_content(std::string(why) + "\n", "text/plain");
        return httplib::Server::HandlerResponse::Handled;
    };
    const auto is_ours = [&](const std::string& host) {
        return host == hosts[0] || host == hosts[1];
    };
    if (request.get_header_value_count("Host") != 1 || !is_ours(request.get_header_value("Host")))
        return refuse(421, "not a host of this server");
    if (request.has_header("Origin")) {
        const std::string origin = request.get_header_value("Origin");
        if (!origin.starts_with("http://") || !is_ours(origin.substr(7)))
            return refuse(403, "requests of other origins are refused");
    }
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    const bool typed = site.empty() || site == "none";
    if (!typed && site != "same-origin") return refuse(403, "requests of other sites are refused");
    if (request.method != "GET" && request.method != "HEAD" && request.method != "POST")
        return refuse(405, "expected GET, HEAD or POST");
    const std::string& path = request.path;
    if (path.size() <= token.size() || !same_text(path.substr(1, token.size()), token))
        return refuse(404, "there is nothing here");
    const bool asks = request.method != "POST";
    if (asks && path.size() == token.size() + 1) {
        response.set_redirect(path + "/", 308);  // names beside the page lie below the slash
        return httplib::Server::HandlerResponse::Handled;
    }
    if (path[token.size() + 1] != '/') return refuse(404, "there is nothing here");
    // What is longer than announced lengths may be is refused when it is read.
    const std::string length = request.get_header_value("Content-Length");
    if (request.has_header("Transfer-Encoding") || (asks && !length.empty() && length != "0"))
        return refuse(413, "expected no body, or a short one of announced length");
    return httplib::Server::HandlerResponse::Unhandled;
}

void ViewServer::State::serve_assets() {
    for (const ViewerAsset& asset : viewer_assets()) {
        const auto send = [&asset](const httplib::Request&, httplib::Response& response) {
            response.set_content(asset.content.data(), asset.content.size(),
                                 std::string(asset.type).c_str());
        };
        // Patterns are regular expressions; a dot of a name matches itself.
        std::string name(asset.name);
        if (const auto dot = name.find('.'); dot != std::string::npos) name.insert(dot, "\\");
        server.Get("/" + token + "/" + name, send);
        if (asset.name == "index.html") server.Get("/" + token + "/", send);
    }
}

void ViewServer::State::serve_solution() {
    server.Get("/" + token + "/solution\\.glb", [this](const httplib::Request&,
                                                       httplib::Response& response) {
        const std::lock_guard lock(mutex);
        if (!solution) {
            response.status = 404;
            response.set_content("not solved yet\n", "text/plain");
            return;
        }
        response.set_header("ETag", fmt::format("\"{}\"", revision));
        response.set_content_provider(
            solution->size(), "model/gltf-binary",
            [file = solution](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                return send(*file, offset, length, sink);
            });
    });
}

/// "delta?from=REVISION": what changed from then to now (byte_delta.h); 410 where that is not known
/// any more and the solution is to be had whole.
void ViewServer::State::serve_deltas() {
    server.Get("/" + token + "/delta", [this](const httplib::Request& request,
                                              httplib::Response& response) {
        const std::string text = request.get_param_value("from");
        std::uint64_t from = 0, to = 0;
        const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), from);
        std::shared_ptr<const OpenFile> before, after;
        {
            const std::lock_guard lock(mutex);
            to = revision, after = solution;
            if (fault == std::errc() && end == text.data() + text.size() && from < to &&
                to - from <= past.size())
                before = past[to - from - 1];
        }
        if (!before || before->size() > most_delta || after->size() > most_delta) {
            response.status = 410;
            response.set_content("that revision is gone\n", "text/plain");
            return;
        }
        response.set_content(
            make_delta(before->content(), after->content(), static_cast<std::uint32_t>(to)),
            "application/octet-stream");
    });
}

/// What the sensors read, computed when a page first asks.
void ViewServer::State::serve_grids() {
    server.Get("/" + token + "/grids\\.json",
               [this](const httplib::Request&, httplib::Response& response) {
                   const std::lock_guard one_at_a_time(reading_grids);
                   std::shared_ptr<const OpenFile> file;
                   {
                       const std::lock_guard lock(mutex);
                       file = solution;
                   }
                   if (!file) {
                       response.status = 404;
                       response.set_content("not solved yet\n", "text/plain");
                       return;
                   }
                   if (file != grids_of) {
                       grids = grid_readings(read_solution(file->path()));
                       grids_of = file;
                   }
                   response.set_content(grids, "application/json");
               });
}

/// Server-sent events: "solution" when there is a new one, "progress" while it is being made.
void ViewServer::State::serve_events() {
    server.Get("/" + token + "/events",
               [this](const httplib::Request&, httplib::Response& response) {
                   {
                       const std::lock_guard lock(mutex);
                       ++pages;
                       deserted_since.reset();
                   }
                   response.set_chunked_content_provider(
                       "text/event-stream",
                       [this, seen_revision = std::uint64_t{0}, seen_told = std::uint64_t{0}](
                           std::size_t, httplib::DataSink& sink) mutable {
                           return send_news(seen_revision, seen_told, sink);
                       },
                       [this](bool) {
                           const std::lock_guard lock(mutex);
                           if (--pages == 0) deserted_since.emplace();
                       });
               });
}

/// Waits for something new for a while; a silent line between shows whether the page still listens.
bool ViewServer::State::send_news(std::uint64_t& seen_revision, std::uint64_t& seen_told,
                                  httplib::DataSink& sink) {
    std::string text;
    {
        std::unique_lock lock(mutex);
        news.wait_for(lock, std::chrono::milliseconds(500),
                      [&] { return ending || revision != seen_revision || told != seen_told; });
        if (ending) return false;
        if (told != seen_told) text += "event: progress\ndata: " + progress + "\n\n";
        if (revision != seen_revision)
            text += fmt::format("event: solution\ndata: {}\n\n", revision);
        seen_told = told, seen_revision = revision;
    }
    if (text.empty()) text = ":\n\n";
    return sink.is_writable() && sink.write(text.data(), text.size());
}

/// {"command": "pause" | "resume" | "stop"}
void ViewServer::State::serve_commands() {
    server.Post("/" + token + "/command", [this](const httplib::Request& request,
                                                 httplib::Response& response) {
        const auto said = nlohmann::json::parse(request.body, nullptr, false);
        const std::string name =
            said.is_object() && said.contains("command") && said["command"].is_string()
                ? said["command"].get<std::string>()
                : "";
        const std::array known{std::pair{"pause", ViewCommand::pause},
                               std::pair{"resume", ViewCommand::resume},
                               std::pair{"stop", ViewCommand::stop}};
        const auto command = std::find_if(known.begin(), known.end(),
                                          [&](const auto& entry) { return name == entry.first; });
        if (command == known.end()) {
            response.status = 400;
            response.set_content("expected {\"command\": \"pause\", \"resume\" or \"stop\"}\n",
                                 "text/plain");
            return;
        }
        std::function<void(ViewCommand)> hear;
        {
            const std::lock_guard lock(mutex);
            hear = heard;
        }
        if (hear) hear(command->second);
        response.status = 204;
    });
}

ViewServer::ViewServer(int port) : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.server.new_task_queue = [] { return new httplib::ThreadPool(threads); };
    s.server.set_payload_max_length(most_body);
    // One request each: what is left of a refused one is nobody's next.
    s.server.set_keep_alive_max_count(1);
    s.server.set_tcp_nodelay(true);
    // Two programs never share a port.
    s.server.set_socket_options([](int socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    s.server.set_default_headers({{"Content-Security-Policy", security_policy},
                                  {"X-Content-Type-Options", "nosniff"},
                                  {"Referrer-Policy", "no-referrer"},
                                  {"Cross-Origin-Resource-Policy", "same-origin"},
                                  {"Cross-Origin-Opener-Policy", "same-origin"},
                                  {"Cache-Control", "no-store"}});
    s.server.set_pre_routing_handler(
        [&s](const httplib::Request& request, httplib::Response& response) {
            return s.gate(request, response);
        });
    s.serve_assets();
    s.serve_solution();
    s.serve_deltas();
    s.serve_grids();
    s.serve_events();
    s.serve_commands();

    const std::string loopback = "127.0.0.1";
    const int bound = port == 0                               ? s.server.bind_to_any_port(loopback)
                      : s.server.bind_to_port(loopback, port) ? port
                                                              : -1;
    if (bound <= 0)
        throw Error(Fault::could_not_finish,
                    port == 0 ? std::string("no port of the loopback can be had")
                              : fmt::format("port {} cannot be had: something else uses it, or it "
                                            "is reserved",
                                            port));
    s.hosts = {fmt::format("127.0.0.1:{}", bound), fmt::format("localhost:{}", bound)};
    s.url = "http://" + s.hosts[0] + "/" + s.token + "/";
    s.listening = std::thread([&s] { s.server.listen_after_bind(); });
}

ViewServer::~ViewServer() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->ending = true;
    }
    state_->news.notify_all();
    while (!state_->server.is_running()) std::this_thread::yield();  // stop() before would be lost
    state_->server.stop();
    state_->listening.join();
}

const std::string& ViewServer::url() const {
    return state_->url;
}

void ViewServer::show(const std::filesystem::path& solution) {
    auto file = std::make_shared<const OpenFile>(solution);
    {
        const std::lock_guard lock(state_->mutex);
        if (state_->solution) state_->past.push_front(std::move(state_->solution));
        if (state_->past.size() > most_past) state_->past.pop_back();
        state_->solution = std::move(file);
        ++state_->revision;
    }
    state_->news.notify_all();
}

void ViewServer::tell_progress(const std::string& json) {
    {
        const std::lock_guard lock(state_->mutex);
        state_->progress = json;
        ++state_->told;
    }
    state_->news.notify_all();
}

void ViewServer::on_command(std::function<void(ViewCommand)> heard) {
    const std::lock_guard lock(state_->mutex);
    state_->heard = std::move(heard);
}

bool ViewServer::deserted() const {
    constexpr double patience = 3;  // seconds in which a page that was reloaded is back
    const std::lock_guard lock(state_->mutex);
    return state_->pages == 0 && state_->deserted_since &&
           state_->deserted_since->seconds() > patience;
}

bool ViewServer::has_pages() const {
    const std::lock_guard lock(state_->mutex);
    return state_->pages > 0;
}

}  // namespace exitance::cli
