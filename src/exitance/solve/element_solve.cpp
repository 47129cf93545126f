// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/element_solve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "exitance/formfactor/pairwise.h"
#include "exitance/run/error.h"
#include "exitance/run/parallel.h"
#include "exitance/solve/cast_emission.h"
#include "exitance/solve/element_methods.h"
#include "exitance/solve/element_vertices.h"
#include "exitance/solve/link_refinement.h"
#include "exitance/transport/dense.h"
#include "exitance/transport/exchange_by_casting.h"
#include "exitance/transport/on_the_fly.h"
#include "exitance/transport/sparse.h"
#include "exitance/transport/stochastic_rays.h"

namespace exitance {

namespace {

// 2 n² bytes: 0.2 GB. A matrix made of a thousand rays per row has gaps by then.
constexpr std::size_t rows_of_dense = 10000;
constexpr std::size_t most_dense_bytes = std::size_t{4} << 30;

// So few pairs are known to a millionth in no time.
constexpr std::size_t rows_of_pairs = 256;

// Stratified rays over a hemisphere miss by about n^-3/4 / 2 of what is uneven in it (ray_count.h);
// what elements reflect differs by half of its mean in an ordinary room.
double casting_error(std::uint32_t rays) {
    return 0.25 * std::pow(rays, -0.75);
}

// A tenth of the error asked for, between 256 rays and 65536.
std::uint32_t rays_for_error(double error) {
    const double rays = std::pow(0.25 / (0.1 * error), 4.0 / 3.0);
    return static_cast<std::uint32_t>(std::clamp(rays, 256.0, 65536.0));
}

class ElementSolve {
  public:
    ElementSolve(Radiosity& radiosity, const ElementOptions& options, const Stop& stop,
                 const Stopwatch& clock, const Observer& observe)
        : radiosity_(radiosity),
          options_(options),
          stop_(stop),
          clock_(clock),
          observe_(observe),
          scene_{radiosity.mesh, radiosity.caster, radiosity.owners, radiosity.two_sided()},
          tolerance_(static_cast<float>(std::max(
              options.solving.error * radiosity.emitted_flux() / radiosity.area(), 1e-30))) {}

    ElementReport run() {
        if (options_.transport == "links") return run_links();
        rows_ = make_element_rows(scene_);
        report_.transport =
            options_.transport.value_or(rows_.size() <= rows_of_dense ? std::string(transports[0])
                                                                      : std::string(transports[1]));
        refuse_what_would_not_fit();
        points_ = make_row_points(scene_, rows_);
        make_caster();
        ElementSystem system = make_system();
        const std::unique_ptr<Transport> transport = make_transport();
        find_direct(system, *transport);
        finish(system, *transport, *solve(system, *transport));
        return report_;
    }

  private:
    // Refine, solve, and refine again for what was found, until no link is too wrong for it.
    ElementReport run_links() {
        report_.transport = "links";
        LinkRefinement links(radiosity_, scene_, link_options());
        links.refine({});
        for (;;) {
            report_.rays = links.rays();
            rows_ = links.rows();
            ElementSystem system = make_system();
            system.direct = links.direct();
            make_caster();
            const std::unique_ptr<LinkTransport> transport = links.transport();
            if (!interrupted()) transport->scale_to(seen_shares());
            const std::unique_ptr<ElementSolver> solver = solve(system, *transport);
            report_.links = links.links();
            if (!interrupted() && links.refine(solver->reflected())) continue;
            finish(system, *transport, *solver);
            report_.bytes += links.bytes();
            if (solver->sweeps() == 0 && links.worth_showing() &&
                interrupted()) {  // what refining has found meanwhile
                darken();
                send(links.reflected());
                average_at_vertices(radiosity_, rows_, links.irradiance());
            }
            return report_;
        }
    }

    // By rays: what every row sees of all the others together.
    std::vector<float> seen_shares() {
        std::vector<float> seen(rows_.size(), 0.0f);
        parallel_for(
            rows_.size(),
            [&](std::size_t i) {
                if (!(rows_.area[i] > 0)) return;
                const std::uint32_t cast =
                    caster_->cast_row(i, [&](std::uint32_t row, float share) {
                        if (rows_.area[row] > 0) seen[i] += share;
                    });
                if (cast > 0) seen[i] /= static_cast<float>(cast);
            },
            8);
        report_.rays += std::uint64_t{caster_->rays()} * rows_.size();
        return seen;
    }

    LinkOptions link_options() {
        LinkOptions out;
        out.error = options_.solving.error;
        out.tolerance = tolerance_;
        out.min_area = options_.min_area;
        out.divide = options_.divide;
        out.column = options_.column;
        out.each_round = [this](const LinkRefinement& links) {
            if (!options_.light_meanwhile || !links.worth_showing()) return;
            rows_ = links.rows();
            light_meanwhile(links.irradiance());
        };
        out.go_on = [this](std::uint64_t rays) {
            report_.rays = rays;
            tell_phase("links");
            return !interrupted();
        };
        return out;
    }

    void make_caster() {
        caster_.emplace(scene_, rows_,
                        options_.rays ? static_cast<std::uint32_t>(*options_.rays)
                                      : rays_for_error(options_.solving.error),
                        options_.column.seed);
    }

    std::unique_ptr<ElementSolver> solve(const ElementSystem& system, Transport& transport) {
        auto solver = element_method(options_.solver).make(system, transport, options_.solving);
        exitance::run(*solver, stop_, clock_, [&](Progress progress) {
            light_meanwhile(solver->irradiance());
            tell(progress);
        });
        darken();
        report_.sweeps += solver->sweeps();
        return solver;
    }

    void finish(const ElementSystem& system, Transport& transport, const ElementSolver& solver) {
        report_.rows = rows_.size();
        report_.shots = transport.counters().shots;
        report_.rays += transport.counters().rays;
        report_.bytes = transport.bytes();
        light_vertices(solver);
        report_.residual = measured_residual(system, transport, solver);
    }

    bool interrupted() const { return stop_.interruption(clock_).has_value(); }

    void tell(Progress progress) const {
        if (!observe_) return;
        progress.seconds = clock_.seconds();
        progress.rays += report_.rays;
        progress.vertices = radiosity_.receivers.size();
        observe_(progress);
    }

    void tell_phase(const char* phase) const {
        Progress progress;
        progress.phase = phase;
        tell(progress);
    }

    void refuse_what_would_not_fit() const {
        const std::size_t bytes = DenseTransport::bytes_for(rows_.size());
        if (report_.transport == "dense" && bytes > most_dense_bytes)
            throw Error(Fault::wrong_use,
                        fmt::format("--transport dense: a matrix of {} elements takes {:.1f} GiB, "
                                    "expected at most 4; --transport sparse or on-the-fly need "
                                    "less, larger elements too (--element-size)",
                                    rows_.size(), double(bytes) / double(1 << 30)));
    }

    ElementSystem make_system() const {
        const std::size_t n = rows_.size(), columns = radiosity_.columns.count;
        ElementSystem out{radiosity_.columns,   rows_.area,           RowField(n, columns),
                          RowField(n, columns), RowField(n, columns), radiosity_.emitted_flux()};
        for (std::size_t i = 0; i < n; ++i) {
            const auto rho = radiosity_.rho(rows_.elements[i]);
            const auto E = radiosity_.emitted(scene_.face(rows_.elements[i]));
            std::copy(rho.begin(), rho.end(), out.rho[RowId(i)].begin());
            std::copy(E.begin(), E.end(), out.emitted[RowId(i)].begin());
        }
        return out;
    }

    // D: lamps by their exact factors and shadow rays at the Gauss points of the elements. A matrix
    // whose every pair is accurate knows better what elements send; luminaires are not in it.
    void find_direct(ElementSystem& system, Transport& transport) {
        const bool by_matrix = pairs_ && !interrupted();
        const std::size_t stride = system.columns.stride;
        std::vector<std::uint32_t> everyone(points_.receivers.size());
        std::iota(everyone.begin(), everyone.end(), 0u);
        Received received;
        received.reset(everyone.size(), stride);
        const Lamps lamps =
            by_matrix ? Lamps(radiosity_, std::span<const FaceId>()) : Lamps(radiosity_);
        report_.rays += cast_emission(radiosity_, lamps, points_.receivers, everyone, tolerance_,
                                      options_.column, received);
        for (std::size_t i = 0; i < rows_.size(); ++i)
            for (std::uint32_t k = points_.begin[i]; k < points_.begin[i + 1]; ++k)
                for (std::size_t c = 0; c < stride; ++c)
                    system.direct[RowId(i)][c] += points_.weight[k] * received.row(k, stride)[c];
        for (std::size_t i = 0; by_matrix && i < rows_.size(); ++i)
            if (radiosity_.emits(scene_.face(rows_.elements[i])))
                transport.shoot(RowId(i), system.emitted[RowId(i)], system.direct);
        light_meanwhile(system.direct);
        tell_phase("direct");
    }

    void darken() {
        radiosity_.irradiance =
            VertexField(radiosity_.irradiance.rows(), radiosity_.irradiance.columns());
    }

    void light_meanwhile(const RowField& irradiance) {
        if (!options_.light_meanwhile) return;
        darken();
        average_at_vertices(radiosity_, rows_, irradiance);
    }

    // Pairs know neither glass nor polygons that share a place.
    void choose_factors() {
        const bool wanted = options_.factors && *options_.factors == "pairs";
        bool shared = false;
        for (const ElementId id : rows_.elements)
            shared = shared ||
                     !scene_.owners.covers(scene_.face(id).polygon, scene_.face(id).back).empty();
        const bool stored = report_.transport == "dense" || report_.transport == "sparse";
        const bool possible = !radiosity_.caster.has_glass() && !shared && stored;
        if (wanted && !possible)
            throw Error(Fault::wrong_use,
                        "--factors pairs cannot be had with " +
                            (shared ? std::string("polygons that lie in one place")
                             : radiosity_.caster.has_glass() ? std::string("glass")
                                                             : "--transport " + report_.transport) +
                            "; expected hemisphere");
        pairs_ = wanted || (!options_.factors && possible && rows_.size() <= rows_of_pairs);
    }

    double pair_accuracy() const {
        return std::clamp(rows_.size() <= rows_of_pairs ? 1e-6 : 0.02 * options_.solving.error,
                          1e-6, 0.1);
    }

    ExchangeAreas pairwise() {
        Enclosure enclosure;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const Element& element = scene_.mesh[rows_.elements[i]];
            Facet facet;
            facet.outline = scene_.mesh.corners(element);
            facet.count = element.count;
            facet.normal = scene_.face(rows_.elements[i]).normal;
            facet.area = double(element.area);
            facet.row = static_cast<std::uint32_t>(i);
            enclosure.facets.push_back(facet);
            enclosure.surfaces.push_back({"", facet.area, 1.0});
        }
        Cancel enough;
        const Observer watch = [&](const Progress& progress) {
            if (interrupted()) enough.request();
            tell(progress);
        };
        try {
            return pairwise_exchange_areas(enclosure, {pair_accuracy()}, watch, &enough);
        } catch (const Error&) {
            if (!interrupted()) throw;
            return ExchangeAreas(rows_.size());
        }
    }

    ExchangeAreas cast() {
        return cast_exchange_areas(*caster_, rows_, [&, before = report_.rays](std::uint64_t rays) {
            report_.rays = before + rays;
            tell_phase("factors");
            return !interrupted();
        });
    }

    std::unique_ptr<Transport> make_transport() {
        choose_factors();
        if (report_.transport == "stochastic") {
            StochasticRaysOptions rays;
            if (options_.rays) rays.rays_per_row = *options_.rays;
            rays.weight = radiosity_.columns.weight;
            rays.seed = options_.column.seed;
            return std::make_unique<StochasticRays>(scene_, rows_, *caster_, std::move(rays));
        }
        const double accuracy = pairs_ ? pair_accuracy() : casting_error(caster_->rays());
        if (report_.transport == "on-the-fly")
            return std::make_unique<OnTheFlyTransport>(
                scene_, rows_, points_, *caster_,
                OnTheFlyOptions{options_.column, tolerance_, radiosity_.columns.weight}, accuracy);
        ExchangeAreas areas = pairs_ ? pairwise() : cast();
        if (report_.transport == "sparse")
            return std::make_unique<SparseTransport>(std::move(areas), rows_.area, accuracy);
        return std::make_unique<DenseTransport>(std::move(areas), rows_.area, accuracy);
    }

    void light_vertices(const ElementSolver& solver) {
        send(solver.reflected());
        if (options_.gather_vertices && !interrupted())
            report_.rays += gather_at_vertices(radiosity_, *caster_, solver.reflected(), tolerance_,
                                               options_.column);
        else
            average_at_vertices(radiosity_, rows_, solver.irradiance());
    }

    void send(const RowField& reflected) {
        radiosity_.emission_shot = true;
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            const auto R = reflected[RowId(i)];
            std::copy(R.begin(), R.end(), radiosity_.shot[rows_.elements[i]].begin());
        }
    }

    double measured_residual(const ElementSystem& system, Transport& transport,
                             const ElementSolver& solver) const {
        RowField H(system.rows(), system.columns.count);
        transport.gather(solver.reflected(), H);
        double square = 0, start = 0;
        for (std::size_t i = 0; i < system.rows(); ++i)
            for (std::size_t c = 0; c < system.columns.count; ++c) {
                const auto rho = double(system.rho[RowId(i)][c]);
                const auto D = double(system.direct[RowId(i)][c]);
                const double r =
                    rho * (D + double(H[RowId(i)][c])) - double(solver.reflected()[RowId(i)][c]);
                const auto weight = double(system.area[i] * system.columns.weight[c]);
                square += weight * r * r, start += weight * rho * rho * D * D;
            }
        return start > 0 ? std::sqrt(square / start) : 0.0;
    }

    Radiosity& radiosity_;
    const ElementOptions& options_;
    const Stop& stop_;
    const Stopwatch& clock_;
    const Observer& observe_;
    ElementScene scene_;
    ElementRows rows_;
    RowPoints points_;
    std::optional<ElementCaster> caster_;
    float tolerance_;
    bool pairs_ = false;  ///< form factors pair by pair, not by rays over hemispheres
    ElementReport report_;
};

}  // namespace

ElementReport solve_elements(Radiosity& radiosity, const ElementOptions& options, const Stop& stop,
                             const Stopwatch& clock, const Observer& observe) {
    return ElementSolve(radiosity, options, stop, clock, observe).run();
}

}  // namespace exitance
