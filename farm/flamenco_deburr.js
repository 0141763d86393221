// One picture in Flamenco 3, a task for each range of samples, and one that merges them. It goes into the manager's
// folder `scripts`.
const JOB_TYPE = {
    label: "Deburr",
    settings: [
        {key: "scene", type: "string", required: true},
        {key: "picture", type: "string", required: true},
        {key: "samples", type: "int32", default: 1024},
        {key: "per_task", type: "int32", default: 64},
    ],
};

function compileJob(job) {
    const {scene, picture, samples, per_task} = job.settings;
    const merge = author.Task("merge", "misc");
    const parts = [];
    for (let first = 0; first < samples; first += per_task) {
        const end = Math.min(first + per_task, samples);
        const part = `${picture}.${first}.sums`;
        const task = author.Task(`samples ${first}-${end}`, "misc");
        task.addCommand(author.Command("exec", {
            exe: "deburr",
            args: ["render", scene, "--spp", `${samples}`, "--samples", `${first}-${end}`, "--checkpoint", part, "--resume"],
        }));
        job.addTask(task);
        merge.addDependency(task);
        parts.push(part);
    }
    merge.addCommand(author.Command("exec", {exe: "deburr", args: ["merge", ...parts, "-o", picture]}));
    job.addTask(merge);
}
