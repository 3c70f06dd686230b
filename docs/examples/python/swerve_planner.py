"""A planner of one's own: of a few manoeuvres, the first that is comfortable, else the one with most room.

understory fly forest --plugin swerve_planner.py --set autopilot.method=python_swerve --video
"""

import understory


@understory.planner(
    "python_swerve",
    keys=[
        understory.Key("bank_rad", 0.9, 0.1, 1.5, "bank of a swerve"),
        understory.Key("hold_s", 0.7, 0.1, 3.0, "time for which the bank is held"),
    ],
)
class SwervePlanner:
    "straight on, or a bank to the side with more room"

    def __init__(self, context):
        self.context = context
        bank_rad, hold_s = context.config["bank_rad"], context.config["hold_s"]
        self.manoeuvres = [[]]  # no command: the guidance back to the course flies all of it
        for share in (0.5, 1.0):
            for side in (-1, 1):
                self.manoeuvres.append([(side * share * bank_rad, 0.0, hold_s)])
                self.manoeuvres.append([(side * share * bank_rad, 0.0, hold_s), (-side * share * bank_rad, 0.0, hold_s)])

    def plan(self, request):
        best = None
        for commands in self.manoeuvres:
            plan = self.context.fly(request, commands)
            if plan.clearance_m >= self.context.comfortable_clearance_m:
                return plan
            if best is None or plan.clearance_m > best.clearance_m:
                best = plan
        return best
