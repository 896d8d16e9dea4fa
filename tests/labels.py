"""Labels of unit tests, as patterns of Google Test. `./gloam test` chooses by them; tests/labels_test.py holds that each fits a test.

SLOW       takes seconds or needs the machine for itself: not in `fast`, in CI two programs at a time
FULL       slow and rarely fails: in `full` alone
SWEEPS     hundreds of seeds: disabled unless asked for, in `full`
UNSANITIZED  speed, memory and means of many samples: not under sanitizers in CI, in `full` they are
"""
SLOW = [
    "CheckModel.StockIsAskedForAsLongAsIsSaid",
    "DrawnComplete.*", "*/DrawnComplete.*",
    "EffectsHashOfMinutes.*",
    "FallenSnow.HashDoesNotDependOnThreadsPaceOrWatchers",
    "GasFlames.*",
    "GasForcesOnDrones.*",
    "GasObstaclesOfHouses.*",
    "GasPlumes.*",
    "GeneratedEnvironment.IsMadeAsTheManualShowsIt",
    "GeneratedPlaces.*",
    "GeneratorRanges.*",
    "McapKill.*",
    "McapRecover.EachOfTheFirst500WritesMayFail",
    "MeshParts.*",
    "MjcfSpec.EveryAttributeIsReadAndEveryFieldIsMirrored",
    "MjcfSpec.SettingAfterwardsIsTheSameAsWritingItInTheFile",
    "PropsPhysics.AllCanBeDrawn",
    "RecordedRun.TheDemoDoesNotDependOnThreadsOrRecording",
    "SoilEffectRun.HashDoesNotDependOnThreadsPaceOrWatchers",
    "SoilPlates.SinkAsBekkerSaysAndTakeTheEnergyOfIt",
    "SoilShear.ADrawnPlateMeetsMohrAndCoulombsLimit",
    "SoilWheel.SinksAsBekkersRigidWheel",
    "ThirdParty.EveryFileThatStockLoadsRoundTrips",
    "ThirdPartyLevel.*",
    "ThirdPartyRun.*", "*/ThirdPartyRun.*",
    "ViewOfARealSimulation.WatchingAThirdPartyRobotChangesNothing",
    "WaterFloats.BallsSinkByStokesLaw",
]
FULL = [
    "GeneratedPlaces.LeaveTheWayFreeThatIsAskedFor",
    "GeneratedPlaces.MakeHallwaysOfAsManyTurnsAsAskedForAndOfTheirLength",
    "GeneratedPlaces.MakeHousesOfAsManyRoomsAsAskedForOnOneOrTwoStoreys",
    "GeneratedPlaces.MakeLooseThingsAndLidsThatStayWhereTheyAre",
    "GeneratedPlaces.MakeTerrainsAtTheExtremesOfTheirParameters",
    "GeneratedPlaces.MakeTheOthersAtTheExtremesOfTheirParameters",
    "GeneratedPlaces.MakeWarehousesAtTheExtremesOfTheirParameters",
    "GeneratorRanges.*AreMade",
]
SWEEPS = ["*.DISABLED_Sweep*"]
UNSANITIZED = [
    "*Allocat*", "AtmosphereReference.*", "PropsPhysics.*", "GasBudget.*", "FastMedia.*",
    "Adaptive.EndsWhenItsUserSaysSo", "Adaptive.HasTheMeanOfEvenSampling", "Adaptive.ReachesWhatIsAskedFor",
    "Bvh.AMillionRays*", "*CameraLensTest.KnownPoints*",
    "Fast.ARareBrightRayMakesNoSpot", "Fast.ARoomIsDarkSoon*", "Fast.CellsLookForLightWhereTheGuideHasFoundIt",
    "Fast.IndirectLightIsThatOfThePathTier", "Fast.LampsInMirrorsLightTheRoom", "Fast.PicturesAreTheSameForAnyNumberOfThreads",
    "Fog.White*", "GasFire.*", "GasFlow.*", "GasWalls.*", "GeneratedEnvironment.OfOneSeedIsOneHash*",
    "Glow.BringsTheLight*", "Glow.FillsAClosedWhiteRoom*", "Guide.IsTheSameWhatever*", "HeightErrorOf.APlane*",
    "ManyLights.ThePictureIsTheSumOfThoseOfEachLight", "MovingSky.TheFastTier*", "MovingSky.TheGround*",
    "Path.WhiteFurnaceReturnsAllLight", "Sky.SamplingAMap*", "TrotWalk.NoFallsInTwentySeedsOfPushes",
]


def only(*lists, but=()):
    """A filter of Google Test: what one of `lists` names, but for `but`."""
    return ":".join(p for patterns in lists for p in patterns) + ("-" + ":".join(but) if but else "")


def without(*lists):
    return "-" + ":".join(p for patterns in lists for p in patterns)
