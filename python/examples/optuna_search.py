"""A study of Papilla searched by Optuna: its samplers ask, Papilla judges, and is told what they found.

Run: python3 optuna_search.py [TRIALS]   (Debian: python3-optuna)
"""

from __future__ import annotations

import sys

import optuna

import papilla as pp

STUDY = pp.Study({
    "base": "m3_samples/a3h350.toml",
    "environment": {"relative_humidity": ["35 %", "75 %"]},
    "design_space": {"texture.depth": ["50 nm", "800 nm"], "texture.diameter": ["1 um", "4 um"]},
    "objective": {"maximise": "mean(modulation)", "minimise": "variation(modulation)"},
    "constraints": {"min_wall": "1.5 um"},
})


def judged(trial: optuna.Trial) -> tuple[float, ...]:
    """The objectives of the point that Optuna suggests; the errors go into the trial."""
    point = {x.path: trial.suggest_float(x.path, x.low, x.high) for x in STUDY.variables}
    judgement = STUDY.judge(point)
    if not judgement.ok:
        raise optuna.TrialPruned(judgement.reason)
    trial.set_user_attr("errors", judgement.errors.tolist())
    return tuple(judgement.values)


def search(trials: int, seed: int = 1) -> optuna.Study:
    directions = ["maximize" if goal.maximise else "minimize" for goal in STUDY.objectives]
    study = optuna.create_study(directions=directions, sampler=optuna.samplers.TPESampler(seed=seed))
    own = {path: value for path, value in STUDY.own.items()}
    study.enqueue_trial(own)
    study.optimize(judged, n_trials=trials)
    return study


def main() -> None:
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    found = search(int(sys.argv[1]) if len(sys.argv) > 1 else 30)
    print("front of", len(found.trials), "trials:")
    for trial in sorted(found.best_trials, key=lambda t: -float(t.values[0])):
        errors = trial.user_attrs["errors"]
        goals = ", ".join(f"{goal.name} {value:.3f} ± {error:.3f}"
                          for goal, value, error in zip(STUDY.objectives, trial.values, errors))
        print(f"  {STUDY.point(trial.params)}: {goals}")


if __name__ == "__main__":
    main()
