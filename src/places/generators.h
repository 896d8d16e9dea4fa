#pragma once
// From what a scene says of its environment to a Place.

#include <optional>

#include "places/place.h"

namespace gloam {

// The generators, a file each. Errors: parameters that leave no room.
Result<Place> make_house(const HouseOptions& options);
Result<Place> make_warehouse(const WarehouseOptions& options);
Result<Place> make_office(const OfficeOptions& options);
Result<Place> make_hallway(const HallwayOptions& options);
Result<Place> make_bedroom(const BedroomOptions& options);
Result<Place> make_tunnel(const TunnelOptions& options);
Result<Place> make_mine(const MineOptions& options);
Result<Place> make_terrain(const TerrainOptions& options);

/// Place made of the scene's environment, its [[prop]]s and its vehicles; empty when it has none.
/// Errors: with the place in the scene file.
Result<std::optional<Place>> make_place(const Scene& scene);

/// An [[agent]] that is a thing of the catalogue.
bool is_vehicle(const AgentOptions& agent);

/// Is the ground of the scene a generator's?
bool has_generator(const EnvironmentOptions& environment);
/// Is it a generated building?
bool has_rooms(const EnvironmentOptions& environment);

/// One generator at most, and not beside a file; props of known kinds.
Status validate_environment(const Scene& scene);

}  // namespace gloam
