"""Labels of unit tests, as patterns of Google Test. `./gloam test` chooses by them; tests/labels_test.py holds that each fits a test.

SLOW       takes seconds or needs the machine for itself: not in `fast`, in CI two programs at a time
FULL       slow and rarely fails, and others nearby promise much the same: in `full` alone
SWEEPS     hundreds of seeds: disabled unless asked for, in `full`
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
    "PropsEverywhere.Stand*",
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
    "Adaptive.HasTheMeanOfEvenSampling",
    "Interactive.CellsLookForLightWhereTheGuideHasFoundIt",
    "InteractiveMedia.FlamesLightTheRoomAsInThePathTier",
    "InteractiveMedia.SmokeIsLitAsByThePathTier",
    "InteractiveMedia.WallsKeepTheLightOfFogOutside",
    "GeneratedPlaces.LeaveTheWayFreeThatIsAskedFor",
    "GeneratedPlaces.MakeHallwaysOfAsManyTurnsAsAskedForAndOfTheirLength",
    "GeneratedPlaces.MakeHousesAtTheExtremesOfTheirParameters",
    "GeneratedPlaces.MakeHousesOfAsManyRoomsAsAskedForOnOneOrTwoStoreys",
    "GeneratedPlaces.MakeLooseThingsAndLidsThatStayWhereTheyAre",
    "GeneratedPlaces.MakeTerrainsAtTheExtremesOfTheirParameters",
    "GeneratedPlaces.MakeTheOthersAtTheExtremesOfTheirParameters",
    "GeneratedPlaces.MakeWarehousesAtTheExtremesOfTheirParameters",
    "GeneratorRanges.*AreMade",
    "GeneratorRanges.AreSoundInside",
    "MeshParts.OfThinAndThickThings",
    "MjcfSpec.SettingAfterwardsIsTheSameAsWritingItInTheFile",
    "MovingLight.TheInteractiveTierFollowsABeacon",
    "Stills.PartsAndObjectsBeyond16BitsAreToldApart",
    "ThirdParty.EveryFileThatStockLoadsRoundTrips",
]
SWEEPS = ["*.DISABLED_Sweep*"]


def only(*lists, but=()):
    """A filter of Google Test: what one of `lists` names, but for `but`."""
    return ":".join(p for patterns in lists for p in patterns) + ("-" + ":".join(but) if but else "")


def without(*lists):
    return "-" + ":".join(p for patterns in lists for p in patterns)
