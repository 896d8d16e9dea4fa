#pragma once
// Constants of the interactive tier, all in one place: unit, useful range and reason of each.
// Device-safe.

#include "render/kernel/scene_view.h"

namespace gloam::interactive {

/// Pixels of an image that some numbers of cells below are for; others have as many per pixel, but
/// kLeastCells at least.
inline constexpr size_t kBudgetPixels = size_t{640} * 480, kLeastCells = 32;

// Lights at a surface.

/// Lights of a scene, at most, that are all sampled at every surface; 1 to kMaxLightsWithoutTree.
inline constexpr uint32_t kMaxFastLights = kMaxLightsWithoutTree;
/// Samples of lights at a surface in view where there are more of them; 1 to 16. Each costs a
/// shadow ray, and the filter takes out the noise of four.
inline constexpr uint32_t kSampledLights = 4;
/// Probability of glowing media for the only sample of a place, and for one of kSampledLights,
/// where lights are too many to be weighed against them; 0 to 1.
inline constexpr float kGlowProbability = 0.5f, kGlowAmongLamps = 1.0f / kSampledLights;

// Lamps by cell.

/// Edge of a lamp cell in the picture [px]: in larger cells more surfaces lie in a penumbra,
/// smaller ones cost rays.
inline constexpr float kLampCellPixels = 10;
/// Visible lamps of a cell up to which a surface takes a sample of each, otherwise kSampledLights
/// in all; 1 to 40. Each costs an evaluation of the BSDF.
inline constexpr uint32_t kMaxLampsOfSurface = 4;
/// A cell leaves the remaining lamps out when their light is less than this fraction of the light
/// of the lamps seen so far; 0 to 1.
inline constexpr float kNegligibleLamps = 0.01f;
/// Light of a lamp that moves, over the brightest of a list, from which surfaces sample it surely;
/// above 0.
inline constexpr float kSureLamp = 0.1f;
/// Growth of a lamp's strength since a cell was made up to which its list holds.
inline constexpr float kMaxLampGrowth = 1.5f;
/// Lamps that a known cell looks at in a picture, at least.
inline constexpr uint32_t kLampsLookedAt = 4;
/// Cells that are looked at once more in an image of kBudgetPixels, and images after which a cell
/// that nothing asks for is dropped.
inline constexpr size_t kOldLampCells = 2000;
inline constexpr uint32_t kLampCellLifetime = 60;

// Reflections.

/// Roughness above which a surface reflects the cache's light instead of tracing a ray; 0 to 1.
/// Its lobe is so wide that light from all directions alike will do.
inline constexpr float kMaxTracedRoughness = 0.6f;
/// Roughness from which one pixel of two by two traces a reflection ray for all; 0 to 1. The
/// reflection is blurred over more than these pixels.
inline constexpr float kLeastSharedRoughness = 0.2f;
/// Widening of a ray's cone at a reflection, over the root of the solid angle of its lobe; 0 to 1.
/// Texture detail that the lobe averages is not sought.
inline constexpr float kLobeWidening = 0.2f;
/// Probability of the specular layer above which a surface is a mirror, and of glass above which it
/// is a pane, for rays of reflections and of the cache; 0 to 1. Such rays follow one of them only.
inline constexpr float kMirrorProbability = 0.8f, kGlassProbability = 0.3f;
/// Surfaces that such a ray follows, at most: in and out of two glasses.
inline constexpr int kMaxEvents = 5;
/// Transmittance of the panes in front below which a camera ray ends; one step of an 8-bit picture.
inline constexpr float kOpaque = 0.004f;

// Media.

/// Steps along a camera ray, a ray of a reflection or of the cache, and the short ray of
/// near_glow(); 2 to 32. Errors of one step are below the noise of the samples in it.
inline constexpr int kCameraSteps = 8, kGatherSteps = 4, kNearGlowSteps = 4;
/// Distance from air [m] below which a lamp's surface lights it by the rays of the cache's cells
/// alone: samples of points of a large lamp grow without bound as they come nearer.
inline constexpr float kNearLamp = 0.25f;
/// Fraction of light that a step scatters from which it asks the cache surely; 0 to 1. Thinner
/// steps ask with that much less probability.
inline constexpr float kCertainScattering = 0.1f;
/// Steps of a ray that take a sample of lamps, of which one stands for all.
inline constexpr int kLampSteps = 2;
/// Weight of all light beside that of lamps where the steps for samples of lamps are chosen; 0 to
/// 1. Lamps may move, so places that they do not light yet must be chosen now and then.
inline constexpr float kUniformLampWeight = 0.1f;
/// Probability of asking for a cell that is kCoarserCellLevels doublings larger; 0 to 1. It stands
/// for cells that are not there yet.
inline constexpr float kCoarserCellProbability = 0.125f;
inline constexpr uint32_t kCoarserCellLevels = 2;

// Cells of the irradiance cache.

/// Least edge of a cell [m]: near the camera, cells must hold more than one ray's footprint.
inline constexpr float kLeastEdge = 0.01f;
/// Blur of the borders between facings, of the normal's components; 0 to 1.
inline constexpr float kFacingBlur = 0.3f;
/// Distance of a cell's place off the surface, in edges; 0 to 0.5. Faces of rooms and boxes like to
/// lie on the borders of cells.
inline constexpr float kSurfaceOffset = 0.3f;
/// Fraction of a cell's directions that near surfaces are assumed to take beside those measured,
/// and their light over that of the others: where few rays met them, they count as darker. 0 to 1.
inline constexpr float kNearPriorFraction = 0.05f, kNearPriorLight = 0.45f;
/// Least fraction of a cell's directions that meets no near surface, so that quotients stay finite.
inline constexpr float kMinFarFraction = 0.05f;
/// Edge of a cell in the picture [px]: smaller cells cost rays, larger ones leak around corners.
inline constexpr float kCellPixels = 32;
/// Edge of a cell over its distance from the camera, at most, for wide lenses [m/m].
inline constexpr float kWidestCell = 0.05f;
/// Cells that the first picture may ask for before they are made twice as wide: each pixel shows a
/// leaf of its own there.
inline constexpr size_t kMaxFirstCells = 8000;
/// Factor on the edges of cells, at most, for that reason.
inline constexpr float kMaxEdgeFactor = 4;

// Rays of the cache's cells.

/// Rays of a cell in an update, and as long as light comes round for the first time; multiples of
/// 16 lanes. They bound the time of a picture.
inline constexpr int kRays = 32, kFirstRays = 16;
/// Rays of a cell side by side that go by the cosine, and then as many by the light guide.
inline constexpr int kRaysPerBatch = 8;
/// Rays that a cell's mean is of, at most: older ones fade, so that light may change.
inline constexpr int kMaxCellRays = 10 * kRays;
/// Rounds of rays through one set of points; then another set begins.
inline constexpr uint32_t kRoundsPerPointSet = 16;
/// Factor by which the memory of a cell shrinks that sees moving things in all directions; >= 1.
inline constexpr float kMotionMemoryDivisor = 40;
/// Fraction of the motion seen by a cell that is still counted one update later; 0 to 1.
inline constexpr float kMotionDecay = 0.75f;
/// Updates after which a cell that nothing asks for is dropped.
inline constexpr uint32_t kCellLifetime = 30;
/// Standard errors, and fraction of the light, by which a region's light may be off by chance.
inline constexpr float kChangeSigma = 3, kNoRegionChange = 0.02f;
/// Luminance of a ray over the cell's usual one beyond which the excess is spread over the region,
/// as few rays meet such a source; in air less, as a filter passes over cells that have too much.
inline constexpr float kBrightest = 16, kBrightestInAir = 8;
/// Fraction of all light that must have changed to count as changed in every cell; 0 to 1.
inline constexpr float kGlobalChangeThreshold = 0.1f;
/// Rounds of an update, at most, while light changes in many cells.
inline constexpr int kMostRounds = 3;
/// Rounds of the first update, the last ones, that make up the mean.
inline constexpr int kMeanRounds = 3;
/// Fraction of all light that the last round may have changed where light has come round.
inline constexpr double kConvergenceThreshold = 0.01;
/// Cells for each one that pixels ask for, and so many more, that rays may ask for.
inline constexpr size_t kFurtherCells = 2, kFurtherMargin = 4000;
/// Spread of the cones of the cells' rays [m/m]: no fine texture is sought.
inline constexpr float kRayConeSpread = 0.15f;
/// Ratio of a geometric series of rounds, at most, that is summed ahead, and least fraction of the
/// light that makes it worth it.
inline constexpr double kMaxSeriesRatio = 0.97, kMinSeriesGain = 0.004;
/// Pictures of the first instant, one upon the other: the first answer is not to be all noise.
inline constexpr uint32_t kFirstPictures = 4;
/// Cells that are traced again for one of these pictures, and for a later one; they bound its time.
inline constexpr size_t kFirstCells = 5000, kMostCells = 2500;
/// The same while the light rests, for an image of kBudgetPixels, and fraction of a cell's
/// directions with moving things from which its light does not.
inline constexpr size_t kSettledCells = 1000;
inline constexpr float kStirred = 0.01f;

// Excess of single rays, spread over regions of cells.

/// Cells and rounds that a region's excess is the mean of, at most: always, as long as light comes
/// round for the first time, and after the light has changed.
inline constexpr float kMaxExcessMemory = 500, kFirstExcessMemory = 50, kChangedExcessMemory = 4;
/// Cells of the region itself that the excess of the wider region counts as; >= 0.
inline constexpr float kRegionPriorCells = 4;
/// Luminance below which a region is dark [cd/m²], so that quotients stay finite.
inline constexpr float kMinLuminance = 1e-20f;

// Filter over earlier pictures, surfaces and points of pixels.

/// Resolution of a frame over that of the image, in both directions: half of the image's pixels,
/// as most of the time is theirs, and successive frames go through different points; 0.5 to 1.
inline constexpr float kFrameScale = 0.70710678f;
/// Points of a pixel that pictures go through, one after the other.
inline constexpr uint32_t kPixelPoints = 16;
/// Deviations around a pixel that its past may be off; more leaves trails, less brings back noise.
inline constexpr float kHistoryClampSigma = 1.6f;
/// Pictures in the mean of a signal, at most: older ones fade.
inline constexpr float kMaxHistory = 8;
/// Luminance of a reflection over that of its neighbours, at most.
inline constexpr float kMaxSpikeRatio = 4;
/// Roughness below which a surface shows a sharp picture of other things, which moves otherwise
/// than the surface does; 0 to 1.
inline constexpr float kSharpMirror = 0.25f;
/// Weight of a new picture, at least, in the reflections of such a surface while it moves; 0 to 1.
inline constexpr float kMovingMirrorWeight = 0.5f;
/// Edge of the patches in which a change of the light is sought [px]; a multiple of 16 lanes.
inline constexpr int kPatch = 16;
/// Fraction of the light by which a patch may change by noise, and weight of the new picture over
/// the rest of the change.
inline constexpr float kNoChange = 0.01f, kChangeResponse = 8;
/// Distance of places from one plane over their distance from the camera, up to which they count as
/// one surface: for signals, and for InteractiveSampleOf::near of four by four pixels [m/m].
inline constexpr float kPlaneTolerance = 0.01f, kNearTolerance = 0.02f;
/// Fraction by which the lengths of rays through air may differ whose light is averaged.
inline constexpr float kSameDepth = 0.2f;
/// Rounds of a surface's filter that blur outliers, too; the others preserve them as edges.
inline constexpr int kSpikeFilterRounds = 2;
/// Squared deviations of light, at most, so that products stay finite.
inline constexpr float kMaxSquaredDeviation = 1e8f;
/// Luminance of a pixel's media over its tile's mean beyond which the excess is spread over it.
inline constexpr float kBrightestAir = 4;
/// Frames in the mean of a pixel, at most, and where it lies between pixels of the image before:
/// there each one blurs a little.
inline constexpr float kMostFrames = 12, kMostMoving = 4;
/// Part of the luminance by which the past of a pixel may be out of the reach of its neighbours
/// before its mean begins again.
inline constexpr float kWrongPast = 0.05f;
/// Deviations around a pixel that its past may be off in the mean over pictures, and fraction of
/// the mean beside that: light that flickers less is noise.
inline constexpr float kMeanClampSigma = 1, kMeanClampSlack = 0.015f;

// Change of the light between two pictures.

/// Edge of the patches in which the gain is measured [px]; a divisor of the lanes.
inline constexpr int kGainPatch = 8;
/// Pixels of a patch that were seen before, at least, to measure its gain.
inline constexpr float kLeastPixels = 8;
/// Standard errors that a change may be by chance; points that are spread over patches make it less
/// than it seems.
inline constexpr float kGainSigma = 1;
/// Largest gain: places that were dark before are a poor reference.
inline constexpr float kMostGain = 4;
/// Way of a lamp [m] and turn of its direction [rad] from picture to picture, and its strength over
/// the strongest lamp's, below which the cache follows it.
inline constexpr float kMaxLampShift = 0.005f, kMaxLampTurn = 0.005f, kMinLampStrength = 0.01f;

}  // namespace gloam::interactive
